# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of a node, the only data that has to be queried from the node itself."""

from __future__ import annotations

import asyncio
import os

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError

_TIMEOUT_S = 20.0


async def parameters_of(platform: str, node: str) -> str:
    """Return the parameters of a node as YAML.

    Runs a separate process that joins the platform; the viewer itself does not join.
    """
    command = own_program("rmw_manycore_py.cli", "param", "dump", "--platform", platform, node)
    process = await asyncio.create_subprocess_exec(
        *command,
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env=dict(os.environ),
    )
    try:
        output, errors = await asyncio.wait_for(process.communicate(), _TIMEOUT_S)
    except asyncio.TimeoutError as error:
        raise ManycoreError(f"{node} does not answer within {_TIMEOUT_S:g} s") from error
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
    if process.returncode != 0:
        said = errors.decode(errors="replace").strip().splitlines()
        raise ManycoreError(said[-1].removeprefix("manycore: ") if said else f"{node}: no answer")
    return output.decode(errors="replace")
