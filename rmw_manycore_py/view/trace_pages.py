# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pages of traces: one of its own for each, which a page of several stacks."""

from __future__ import annotations

import asyncio
import html
from collections.abc import Sequence

from aiohttp import web

from rmw_manycore_py.view.pages import PAGE, Pages
from rmw_manycore_py.view.trace_run import TraceRun
from rmw_manycore_py.view.trace_viewer import TraceViewer


class TracePages(Pages):
    """Request handlers of the page of a trace."""

    def __init__(self, run: TraceRun) -> None:
        super().__init__(lambda: TraceViewer(run))
        self._run = run

    def routes(self, root: str) -> list[web.AbstractRouteDef]:
        """Return their paths below `root`."""
        return [*super().routes(root), web.get(f"{root}/chains", self.chains)]

    async def chains(self, _request: web.Request) -> web.StreamResponse:
        """Send the latency of all chains."""
        return web.json_response(await asyncio.to_thread(lambda: self._run.chains))


def stacked_routes(root: str, names: Sequence[str]) -> list[web.AbstractRouteDef]:
    """Return the paths of the page that shows the pages `root`/0, `root`/1 and so on."""
    frames = "".join(
        f'<iframe src="{number}/" title="{html.escape(name)}"></iframe>'
        for number, name in enumerate(names)
    )
    page = (PAGE / "stack.html").read_text().replace("<!-- frames -->", frames)

    async def index(_request: web.Request) -> web.StreamResponse:
        return web.Response(text=page, content_type="text/html")

    return [web.get(f"{root}/", index), web.static(f"{root}/page", PAGE)]
