# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Access control of the page: own user, token in the link, local address, same origin."""

from __future__ import annotations

import errno
import hmac
import os
from collections.abc import Awaitable, Callable

from aiohttp import web

from rmw_manycore_py.view.client_user import ClientUsers
from rmw_manycore_py.view.listener import ADDRESS, Listener

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

_HEADERS = {
    # Only resources of this server, and no embedding in pages of others.
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src 'self' data:; frame-src 'self'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'self'"
    ),
    "Referrer-Policy": "no-referrer",  # the referrer would contain the token
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}

_NOT_FOUND = (errno.ENOENT, errno.ENAMETOOLONG, errno.ENOTDIR)


class Access:
    """Checks each request; the token is the first part of its path."""

    def __init__(self, listener: Listener) -> None:
        self.listener = listener
        self._hosts = {f"{name}:{listener.port}" for name in (ADDRESS, "localhost")}
        self._origins = {f"http://{host}" for host in self._hosts}
        self._users = ClientUsers()

    @web.middleware
    async def check(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Forward or reject a request."""
        refusal = self._refusal(request)
        if refusal:
            response: web.StreamResponse = web.Response(status=403, text=refusal)
        else:
            response = await _handled(request, handler)
        if not response.prepared:
            response.headers.update(_HEADERS)
        return response

    def _refusal(self, request: web.Request) -> str:
        """Return why a request is rejected; "" if it is not."""
        if request.headers.get("Host") not in self._hosts:
            # DNS rebinding: a foreign page resolves its own name to this address.
            return "manycore view answers to 127.0.0.1 and localhost only"
        if refusal := self._refusal_of_user(request):
            return refusal
        origin = request.headers.get("Origin")
        must_have_one = request.method != "GET" or "Upgrade" in request.headers
        if origin not in self._origins and (origin is not None or must_have_one):
            return "manycore view answers to its own page only"
        # The path of "OPTIONS *" has no part; undecodable bytes are surrogates in it.
        given = request.path.removeprefix("/").partition("/")[0].encode(errors="replace")
        if not hmac.compare_digest(given, self.listener.token.encode()):
            return "wrong token: open the link that this manycore view has printed"
        return ""

    def _refusal_of_user(self, request: web.Request) -> str:
        """Return why the sender is rejected: neither this user nor a relay of the system (WSL)."""
        try:
            user = self._users.of(request.transport)
        except OSError as error:
            return f"manycore view cannot tell which user asks: {error}"
        if user is None:
            return "manycore view cannot tell which user asks: /proc/net/tcp lacks the connection"
        if user not in (os.geteuid(), 0):
            return "manycore view answers to the user who started it only"
        return ""


async def _handled(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Await the handler; a path that cannot be a file is not found, e.g. for its long name."""
    try:
        return await handler(request)
    except ConnectionError:  # the page was closed
        raise
    except OSError as error:
        status = 404 if error.errno in _NOT_FOUND else 500
        return web.Response(status=status, text=error.strerror or str(error))
