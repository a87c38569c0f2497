# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests that reach into the running platform: traces, messages, parameters, restarts."""

from __future__ import annotations

import asyncio
import contextlib
import re
from collections.abc import Awaitable
from typing import Any

from aiohttp import web

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.view.commands import output_of, samples_of
from rmw_manycore_py.view.pages import Pages, problem
from rmw_manycore_py.view.tracing import Tracing
from rmw_manycore_py.view.viewer import Viewer

_PLACE = re.compile(r"\d{1,4}(:\d{1,4})?", re.ASCII)


class Requests:
    """Request handlers."""

    def __init__(self, viewer: Viewer, tracing: Tracing, pages: Pages) -> None:
        self._viewer = viewer
        self._tracing = tracing
        self._pages = pages

    def routes(self, root: str) -> list[web.RouteDef]:
        """Return their paths below `root`."""
        return [
            web.post(f"{root}/trace/start", self.start_trace),
            web.post(f"{root}/trace/stop", self.stop_trace),
            web.get(f"{root}/trace/{{name}}", self.trace_file),
            web.get(f"{root}/samples", self.samples),
            web.post(f"{root}/parameters", self.parameters),
            web.post(f"{root}/restart", self.restart),
            web.post(f"{root}/move", self.move),
        ]

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
            return problem(404, "no such trace")
        said = {"Content-Disposition": f'attachment; filename="{path.name}"'}
        return web.FileResponse(path, headers=said)

    async def samples(self, request: web.Request) -> web.StreamResponse:
        """Send messages of a topic until the page closes the WebSocket."""
        topic, look = request.query.get("topic", ""), self._viewer.look
        if (absence := self._absence()) is not None:
            return absence
        if look is None or topic not in look.graph.topics:
            return problem(404, f"no topic '{topic}'")
        async with self._pages.connected(request) as live:
            sending = asyncio.create_task(_send_samples(live, self._viewer.platform, topic))
            try:
                async for _ in live:
                    pass
            finally:
                sending.cancel()
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
            return problem(400, f"expected a cluster such as 2, or a core as 2:3, found '{place}'")
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
            return problem(404, f"no node '{node}'")
        verb, *rest = words
        given = [*rest, node] if verb == "param" else [node, *rest]
        return await _answered(output_of(verb, *given, "--platform", self._viewer.platform))

    def _absence(self) -> web.StreamResponse | None:
        return None if self._viewer.is_there else problem(409, self._viewer.state)


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
        return problem(409, str(error))
