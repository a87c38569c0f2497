# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Access to the page: by its link, on this machine, from no other site's page."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable

from aiohttp import web

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]
ADDRESS = "127.0.0.1"
_TOKEN_BYTES = 18

_HEADERS = {
    # Nothing but what this server sends, and no other page around it.
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Referrer-Policy": "no-referrer",  # it would carry the token
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}


class Access:
    """Checks each request; the token is the first part of each path."""

    def __init__(self, port: int) -> None:
        self.token = secrets.token_urlsafe(_TOKEN_BYTES)
        self._hosts = {f"{name}:{port}" for name in (ADDRESS, "localhost")}
        self._origins = {f"http://{host}" for host in self._hosts}

    def link(self, port: int) -> str:
        """Return the address to open."""
        return f"http://{ADDRESS}:{port}/{self.token}/"

    @web.middleware
    async def check(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Hand a request on, or refuse it."""
        refusal = self._refusal(request)
        response = web.Response(status=403, text=refusal) if refusal else await handler(request)
        if not response.prepared:
            response.headers.update(_HEADERS)
        return response

    def _refusal(self, request: web.Request) -> str:
        """Return why a request is refused, "" if it is not."""
        if request.headers.get("Host") not in self._hosts:
            # Another name for this address: a page elsewhere has its name resolved to here.
            return "manycore view answers to 127.0.0.1 and localhost only"
        origin = request.headers.get("Origin")
        must_have_one = request.method != "GET" or "Upgrade" in request.headers
        if origin not in self._origins and (origin is not None or must_have_one):
            return "manycore view answers to its own page only"
        given = request.path.split("/")[1]
        if not hmac.compare_digest(given.encode(), self.token.encode()):
            return "wrong token: open the link that this manycore view has printed"
        return ""
