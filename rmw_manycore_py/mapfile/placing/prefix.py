# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Launch prefixes that would take a node off the CPU or the scheduling of the mapfile."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rmw_manycore_py.process.scheduling import Scheduling

_PINNING = frozenset({"taskset", "numactl"})
_SCHEDULING = frozenset({"chrt"})


def placed_again(
    prefix: Sequence[str], host_cpu: int, scheduling: Scheduling | None
) -> tuple[str, ...]:
    """Return what has to follow a prefix such that the mapfile's placement takes effect.

    Nothing for prefixes that leave the placement alone, as debuggers and profilers have to start
    the node itself.
    """
    tools = {Path(word).name for word in prefix}
    words: list[str] = []
    if scheduling is not None and tools & _SCHEDULING:
        words += ["chrt", f"--{scheduling.policy}", str(scheduling.priority)]
    if tools & _PINNING:
        words += ["taskset", "--cpu-list", str(host_cpu)]
    return tuple(words)
