# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Platform settings of a process without ROS, read from its environment."""

from __future__ import annotations

import os
from typing import get_args

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native.enums import WaitMode

MAX_CLUSTER = 64
MAX_CORE = 1023


def own_cluster() -> int:
    """Return $MANYCORE_CLUSTER, by default 1.

    :raises ManycoreError: if it is not a valid cluster.
    """
    cluster = _number("MANYCORE_CLUSTER", 1, MAX_CLUSTER)
    return 1 if cluster is None else cluster


def own_core() -> int | None:
    """Return $MANYCORE_CORE, by default None (no core).

    :raises ManycoreError: if it is not a valid core.
    """
    return _number("MANYCORE_CORE", 0, MAX_CORE)


def own_wait_mode() -> WaitMode:
    """Return $MANYCORE_WAIT, by default block.

    :raises ManycoreError: if it is not a wait mode.
    """
    found = os.environ.get("MANYCORE_WAIT") or "block"
    modes: tuple[WaitMode, ...] = get_args(WaitMode)
    for mode in modes:
        if mode == found:
            return mode
    raise _refusal("MANYCORE_WAIT", " or ".join(modes), found)


def _number(variable: str, lowest: int, highest: int) -> int | None:
    text = os.environ.get(variable)
    if not text:
        return None
    if not (text.isascii() and text.isdecimal() and lowest <= int(text) <= highest):
        raise _refusal(variable, f"a number from {lowest} to {highest}", text)
    return int(text)


def _refusal(variable: str, expected: str, found: str) -> ManycoreError:
    return ManycoreError(f"{variable}: expected {expected}, found '{found}'", EXIT_BAD_INPUT)
