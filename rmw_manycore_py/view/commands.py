# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the page asks `manycore` to do: each command is a process of its own.

The viewer itself joins no platform. Names come from the page: callers check that they are known.
"""

from __future__ import annotations

import asyncio
import os
import signal
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import AsyncGenerator, AsyncIterator
from contextlib import asynccontextmanager

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError

_TIMEOUT_S = 20.0
MAX_LINE_BYTES = 4 << 20


async def output_of(*words: str) -> str:
    """Return what a command of `manycore` prints.

    :raises ManycoreError: with its last words if it fails.
    """
    async with _started("rmw_manycore_py.cli", *words) as process:
        try:
            output, errors = await asyncio.wait_for(process.communicate(), _TIMEOUT_S)
        except asyncio.TimeoutError as error:
            raise ManycoreError(f"no answer within {_TIMEOUT_S:g} s") from error
    if process.returncode != 0:
        raise ManycoreError(_last_words(errors))
    return output.decode(errors="replace")


async def samples_of(platform: str, topic: str) -> AsyncGenerator[str, None]:
    """Yield messages of a topic as JSON, until closed.

    :raises ManycoreError: if they cannot be read.
    """
    async with _started("rmw_manycore_py.cli.topic.samples", platform, topic) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        async for line in process.stdout:
            yield line.decode(errors="replace")
        raise ManycoreError(_last_words(await process.stderr.read()))


@asynccontextmanager
async def _started(module: str, *words: str) -> AsyncIterator[Process]:
    """Start a program of ours; kill it in the end, unless it has ended."""
    process = await asyncio.create_subprocess_exec(
        *own_program(module, *words),
        stdin=DEVNULL,
        stdout=PIPE,
        stderr=PIPE,
        env=dict(os.environ),
        limit=MAX_LINE_BYTES,
    )
    try:
        yield process
    finally:
        if process.returncode is None:
            process.send_signal(signal.SIGINT)
            try:
                await asyncio.wait_for(process.wait(), 1.0)
            except asyncio.TimeoutError:
                process.kill()
                await process.wait()


def _last_words(errors: bytes) -> str:
    said = errors.decode(errors="replace").strip().splitlines()
    return said[-1].removeprefix("manycore: ") if said else "no answer"
