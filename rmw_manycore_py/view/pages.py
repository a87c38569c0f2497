# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests of every page: its files, its picture, and the news for it."""

from __future__ import annotations

import asyncio
import contextlib
import re
from collections.abc import AsyncIterator, Callable
from pathlib import Path

from aiohttp import WSMsgType, web

from rmw_manycore_py.picture.drawing import stylesheet
from rmw_manycore_py.view.page_state import PageState
from rmw_manycore_py.view.shown import Shown

PAGE = Path(__file__).parent / "page"
MAX_REQUEST_BYTES = 4096
_STEP = re.compile(r"\d{1,4}", re.ASCII)


class Pages:
    """Request handlers."""

    def __init__(self, shown_to_page: Callable[[], Shown]) -> None:
        """Serve pages.

        :param shown_to_page: returns what a newly opened page shows.
        """
        self._shown_to_page = shown_to_page
        self._sockets: set[web.WebSocketResponse] = set()

    def routes(self, root: str) -> list[web.AbstractRouteDef]:
        """Return their paths below `root`."""
        return [
            web.get(f"{root}/", self.index),
            web.get(f"{root}/chip.css", self.style),
            web.get(f"{root}/chip.svg", self.picture),
            web.get(f"{root}/live", self.live),
            web.static(f"{root}/page", PAGE),
        ]

    async def close(self, _app: web.Application) -> None:
        """Notify the pages that the server stops."""
        for live in list(self._sockets):
            await live.close(message=b"manycore view has ended")

    async def index(self, _request: web.Request) -> web.StreamResponse:
        """Send the page."""
        return web.FileResponse(PAGE / "index.html")

    async def style(self, _request: web.Request) -> web.StreamResponse:
        """Send the style sheet of the picture."""
        return web.Response(text=stylesheet(), content_type="text/css")

    async def picture(self, request: web.Request) -> web.StreamResponse:
        """Send the current picture as a standalone SVG, or that of a step of a trace."""
        shown = self._shown_to_page()
        if _STEP.fullmatch(step := request.query.get("step", "")):
            shown.seek(int(step))
        if shown.chip is None:
            return problem(404, shown.state)
        return web.Response(text=shown.chip.svg(shown.marks), content_type="image/svg+xml")

    async def live(self, request: web.Request) -> web.StreamResponse:
        """Send updates with each look until the page is closed."""
        async with self.connected(request) as live:
            shown = self._shown_to_page()
            state = PageState(shown)
            received = asyncio.Event()
            sending = asyncio.create_task(_send(live, shown, state, received))
            try:
                async for message in live:
                    if message.type == WSMsgType.TEXT:
                        with contextlib.suppress(ValueError, RecursionError):
                            state.receive(message.json())
                            received.set()
            finally:
                sending.cancel()
        return live

    @contextlib.asynccontextmanager
    async def connected(self, request: web.Request) -> AsyncIterator[web.WebSocketResponse]:
        """Answer with a WebSocket, which `close` also closes."""
        live = web.WebSocketResponse(heartbeat=20, max_msg_size=MAX_REQUEST_BYTES)
        await live.prepare(request)
        self._sockets.add(live)
        try:
            yield live
        finally:
            self._sockets.discard(live)


async def _send(
    live: web.WebSocketResponse, shown: Shown, state: PageState, received: asyncio.Event
) -> None:
    with contextlib.suppress(ConnectionError):
        while not live.closed:
            await live.send_json(state.news())
            received.clear()
            waiting = [
                asyncio.ensure_future(shown.next_look()),
                asyncio.ensure_future(received.wait()),
            ]
            try:
                await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
            finally:
                for one in waiting:
                    one.cancel()


def problem(status: int, text: str) -> web.StreamResponse:
    """Return an error as JSON."""
    return web.json_response({"error": text}, status=status)
