# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which clients the view server accepts, and what its failures look like over a connection."""

from __future__ import annotations

import asyncio
import errno
import os
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from aiohttp import ClientSession, web

from rmw_manycore_py.view import client_user
from rmw_manycore_py.view.access import Access, Handler
from rmw_manycore_py.view.listener import listen

pytestmark = pytest.mark.unit


def served(handler: Handler, ask: Callable[[str], Awaitable[None]]) -> None:
    """Serve a page while `ask` is awaited with its link."""

    async def serve() -> None:
        listener = listen(0)
        app = web.Application(middlewares=[Access(listener).check])
        app.router.add_get(f"/{listener.token}/", handler)
        runner = web.AppRunner(app)
        await runner.setup()
        try:
            await web.SockSite(runner, listener.socket).start()
            await ask(listener.link)
        finally:
            await runner.cleanup()

    asyncio.run(serve())


async def answer(session: ClientSession, link: str) -> tuple[int, str]:
    async with session.get(link) as response:
        return response.status, await response.text()


async def hello(_request: web.Request) -> web.StreamResponse:
    return web.Response(text="hello")


def test_a_connection_is_looked_up_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    async def ask(link: str) -> None:
        async with ClientSession() as known, ClientSession() as late:
            assert await answer(known, link) == (200, "hello")
            missing = tmp_path / "tcp"
            monkeypatch.setattr(client_user, "_TABLE", missing)
            assert await answer(known, link) == (200, "hello")
            status, text = await answer(late, link)
            assert (status, "cannot tell which user asks" in text) == (403, True)
            assert str(missing) in text

    served(hello, ask)


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (OSError(errno.ENAMETOOLONG, os.strerror(errno.ENAMETOOLONG)), 404),
        (FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT)), 404),
        (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), 500),
        (OSError("cannot be written"), 500),
    ],
)
def test_only_a_path_that_is_none_is_not_found(error: OSError, status: int) -> None:
    async def fails(_request: web.Request) -> web.StreamResponse:
        raise error

    async def ask(link: str) -> None:
        async with ClientSession() as session:
            assert await answer(session, link) == (status, error.strerror or str(error))

    served(fails, ask)
