# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Web server of the page, on 127.0.0.1 only."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re
import tempfile
from collections.abc import AsyncIterator, Awaitable
from pathlib import Path
from typing import Any

from aiohttp import WSMsgType, web
from aiohttp.http_exceptions import HttpProcessingError

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.picture.drawing import stylesheet
from rmw_manycore_py.view.access import Access
from rmw_manycore_py.view.commands import output_of, samples_of
from rmw_manycore_py.view.listener import Listener
from rmw_manycore_py.view.page_state import PageState
from rmw_manycore_py.view.tracing import Tracing
from rmw_manycore_py.view.viewer import Viewer

_PAGE = Path(__file__).parent / "page"
_MAX_REQUEST_BYTES = 4096
_SHUTDOWN_S = 1.0
_PLACE = re.compile(r"\d{1,4}(:\d{1,4})?", re.ASCII)


def serve(platform: str, listener: Listener, period_s: float) -> None:
    """Serve the page until a signal."""
    logging.getLogger("aiohttp.server").addFilter(_is_of_server)
    with tempfile.TemporaryDirectory(prefix="manycore-view-") as kept:
        app = application(platform, period_s, Access(listener), Path(kept))
        web.run_app(
            app, sock=listener.socket, print=None, access_log=None, shutdown_timeout=_SHUTDOWN_S
        )


def _is_of_server(record: logging.LogRecord) -> bool:
    """Return whether an error is ours: aiohttp also logs each request that is not HTTP."""
    return record.exc_info is None or not isinstance(record.exc_info[1], HttpProcessingError)


def application(platform: str, period_s: float, access: Access, kept: Path) -> web.Application:
    """Return the web application: page, live data, traces."""
    pages = Pages(Viewer(platform, period_s), Tracing(platform, kept))
    app = web.Application(middlewares=[access.check], client_max_size=_MAX_REQUEST_BYTES)
    app.cleanup_ctx.append(pages.looking)
    app.on_shutdown.append(pages.close)
    root = f"/{access.listener.token}"
    app.add_routes(
        [
            web.get(f"{root}/", pages.index),
            web.get(f"{root}/chip.css", pages.style),
            web.get(f"{root}/chip.svg", pages.picture),
            web.get(f"{root}/live", pages.live),
            web.post(f"{root}/trace/start", pages.start_trace),
            web.post(f"{root}/trace/stop", pages.stop_trace),
            web.get(f"{root}/trace/{{name}}", pages.trace_file),
            web.get(f"{root}/samples", pages.samples),
            web.post(f"{root}/parameters", pages.parameters),
            web.post(f"{root}/restart", pages.restart),
            web.post(f"{root}/move", pages.move),
            web.static(f"{root}/page", _PAGE),
        ]
    )
    return app


class Pages:
    """Request handlers."""

    def __init__(self, viewer: Viewer, tracing: Tracing) -> None:
        self._viewer = viewer
        self._tracing = tracing
        self._sockets: set[web.WebSocketResponse] = set()

    async def looking(self, _app: web.Application) -> AsyncIterator[None]:
        """Watch the platform while the server runs."""
        task = asyncio.create_task(self._viewer.run())
        yield
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task

    async def close(self, _app: web.Application) -> None:
        """Notify the pages that the server stops."""
        for live in list(self._sockets):
            await live.close(message=b"manycore view has ended")

    async def index(self, _request: web.Request) -> web.StreamResponse:
        """Send the page."""
        return web.FileResponse(_PAGE / "index.html")

    async def style(self, _request: web.Request) -> web.StreamResponse:
        """Send the style sheet of the picture."""
        return web.Response(text=stylesheet(), content_type="text/css")

    async def picture(self, _request: web.Request) -> web.StreamResponse:
        """Send the current picture as a standalone SVG."""
        chip = self._viewer.chip
        if chip is None:
            return _problem(404, self._viewer.state)
        return web.Response(text=chip.svg(self._viewer.marks), content_type="image/svg+xml")

    async def live(self, request: web.Request) -> web.StreamResponse:
        """Send updates with each look until the page is closed."""
        live = web.WebSocketResponse(heartbeat=20, max_msg_size=_MAX_REQUEST_BYTES)
        await live.prepare(request)
        self._sockets.add(live)
        state = PageState(self._viewer)
        selected = asyncio.Event()
        sending = asyncio.create_task(self._send(live, state, selected))
        try:
            async for message in live:
                if message.type == WSMsgType.TEXT:
                    with contextlib.suppress(ValueError, RecursionError):
                        state.select(message.json())
                        selected.set()
        finally:
            sending.cancel()
            self._sockets.discard(live)
        return live

    async def _send(
        self, live: web.WebSocketResponse, state: PageState, selected: asyncio.Event
    ) -> None:
        with contextlib.suppress(ConnectionError):
            while not live.closed:
                await live.send_json(state.news())
                selected.clear()
                waiting = [
                    asyncio.ensure_future(self._viewer.next_look()),
                    asyncio.ensure_future(selected.wait()),
                ]
                try:
                    await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
                finally:
                    for one in waiting:
                        one.cancel()

    async def start_trace(self, _request: web.Request) -> web.StreamResponse:
        """Start a trace."""
        if (absence := self._absence()) is not None:
            return absence
        return await _answered(asyncio.to_thread(self._tracing.start))

    async def stop_trace(self, _request: web.Request) -> web.StreamResponse:
        """Stop a trace and save it."""
        if (absence := self._absence()) is not None:
            return absence
        return await _answered(asyncio.to_thread(self._tracing.stop))

    async def trace_file(self, request: web.Request) -> web.StreamResponse:
        """Send a saved trace."""
        path = self._tracing.file(request.match_info["name"])
        if path is None:
            return _problem(404, "no such trace")
        said = {"Content-Disposition": f'attachment; filename="{path.name}"'}
        return web.FileResponse(path, headers=said)

    async def samples(self, request: web.Request) -> web.StreamResponse:
        """Send messages of a topic until the page closes the WebSocket."""
        topic, look = request.query.get("topic", ""), self._viewer.look
        if (absence := self._absence()) is not None:
            return absence
        if look is None or topic not in look.graph.topics:
            return _problem(404, f"no topic '{topic}'")
        live = web.WebSocketResponse(heartbeat=20, max_msg_size=_MAX_REQUEST_BYTES)
        await live.prepare(request)
        self._sockets.add(live)
        sending = asyncio.create_task(_send_samples(live, self._viewer.platform, topic))
        try:
            async for _ in live:
                pass
        finally:
            sending.cancel()
            self._sockets.discard(live)
            with contextlib.suppress(asyncio.CancelledError):
                await sending
        return live

    async def parameters(self, request: web.Request) -> web.StreamResponse:
        """Query a node's parameters."""
        return await self._command(request, "param", "dump")

    async def restart(self, request: web.Request) -> web.StreamResponse:
        """Restart a node of a run."""
        return await self._command(request, "restart")

    async def move(self, request: web.Request) -> web.StreamResponse:
        """Restart a node of a run on another core."""
        place = request.query.get("place", "")
        if not _PLACE.fullmatch(place):
            return _problem(400, f"expected a cluster such as 2, or a core as 2:3, found '{place}'")
        return await self._command(request, "move", place)

    async def _command(self, request: web.Request, *words: str) -> web.StreamResponse:
        """Run a command about a node, unless the platform has ended: it would start anew."""
        if (absence := self._absence()) is not None:
            return absence
        node, look = request.query.get("node", ""), self._viewer.look
        known = look is not None and any(
            node in member.nodes for member in (*look.graph.members, *look.dead)
        )
        if not known:
            return _problem(404, f"no node '{node}'")
        verb, *rest = words
        given = [*rest, node] if verb == "param" else [node, *rest]
        return await _answered(output_of(verb, *given, "--platform", self._viewer.platform))

    def _absence(self) -> web.StreamResponse | None:
        return None if self._viewer.is_there else _problem(409, self._viewer.state)


async def _send_samples(live: web.WebSocketResponse, platform: str, topic: str) -> None:
    with contextlib.suppress(ConnectionError):
        try:
            async with contextlib.aclosing(samples_of(platform, topic)) as samples:
                async for sample in samples:
                    await live.send_str(sample)
        except ManycoreError as error:
            await live.send_json({"error": str(error)})


async def _answered(work: Awaitable[Any]) -> web.StreamResponse:
    """Return the awaited result as JSON, or an error."""
    try:
        return web.json_response({"result": await work})
    except ManycoreError as error:
        return _problem(409, str(error))


def _problem(status: int, text: str) -> web.StreamResponse:
    return web.json_response({"error": text}, status=status)
