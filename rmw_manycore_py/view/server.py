# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Web server of the page, on 127.0.0.1 only."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import tempfile
from collections.abc import AsyncIterator, Sequence
from pathlib import Path

from aiohttp import web
from aiohttp.http_exceptions import HttpProcessingError

from rmw_manycore_py.view.access import Access
from rmw_manycore_py.view.listener import Listener
from rmw_manycore_py.view.pages import MAX_REQUEST_BYTES, Pages
from rmw_manycore_py.view.requests import Requests
from rmw_manycore_py.view.trace_pages import TracePages, stacked_routes
from rmw_manycore_py.view.trace_run import TraceRun
from rmw_manycore_py.view.tracing import Tracing
from rmw_manycore_py.view.viewer import Viewer

_SHUTDOWN_S = 1.0


def serve(platform: str, listener: Listener, period_s: float) -> None:
    """Serve the page of a platform until a signal."""
    with tempfile.TemporaryDirectory(prefix="manycore-view-") as kept:
        _run(application(platform, period_s, Access(listener), Path(kept)), listener)


def serve_traces(runs: Sequence[TraceRun], listener: Listener) -> None:
    """Serve the page of one or several traces until a signal."""
    _run(trace_application(runs, Access(listener)), listener)


def _run(app: web.Application, listener: Listener) -> None:
    logging.getLogger("aiohttp.server").addFilter(_is_of_server)
    web.run_app(
        app, sock=listener.socket, print=None, access_log=None, shutdown_timeout=_SHUTDOWN_S
    )


def _is_of_server(record: logging.LogRecord) -> bool:
    """Return whether an error is ours: aiohttp also logs each request that is not HTTP."""
    return record.exc_info is None or not isinstance(record.exc_info[1], HttpProcessingError)


def application(platform: str, period_s: float, access: Access, kept: Path) -> web.Application:
    """Return the web application: page, live data, traces."""
    viewer = Viewer(platform, period_s)
    pages = Pages(lambda: viewer)
    requests = Requests(viewer, Tracing(platform, kept), pages)
    app = _empty_application(access)

    async def looking(_app: web.Application) -> AsyncIterator[None]:
        task = asyncio.create_task(viewer.run())
        yield
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task

    app.cleanup_ctx.append(looking)
    app.on_shutdown.append(pages.close)
    root = f"/{access.listener.token}"
    app.add_routes([*pages.routes(root), *requests.routes(root)])
    return app


def trace_application(runs: Sequence[TraceRun], access: Access) -> web.Application:
    """Return the web application of traces; several have a page each, one above another."""
    app = _empty_application(access)
    root = f"/{access.listener.token}"
    roots = [root] if len(runs) == 1 else [f"{root}/{number}" for number in range(len(runs))]
    for run, own_root in zip(runs, roots, strict=True):
        pages = TracePages(run)
        app.on_shutdown.append(pages.close)
        app.add_routes(pages.routes(own_root))
    if len(runs) > 1:
        app.add_routes(stacked_routes(root, [run.name for run in runs]))
    return app


def _empty_application(access: Access) -> web.Application:
    return web.Application(middlewares=[access.check], client_max_size=MAX_REQUEST_BYTES)
