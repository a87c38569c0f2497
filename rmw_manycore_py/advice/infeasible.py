# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A conflict in words, with the nearest way out."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.advice.conflict import Conflict
from rmw_manycore_py.advice.model import CORES, MEMORY
from rmw_manycore_py.advice.problem import Problem
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.smem import Smem
from rmw_manycore_py.platform.texts import counted, listed, size_text
from rmw_manycore_py.platform.topology import MIB, Topology, room_for_topic_dsms


class InfeasibleError(ManycoreError):
    """No mapping keeps all limits."""

    def __init__(self, problem: Problem, topology: Topology, conflict: Conflict | None) -> None:
        self.conflict = conflict
        lines = [*_lines(problem, topology, conflict)] if conflict else [_UNKNOWN]
        super().__init__("\n".join(lines), EXIT_BAD_INPUT)


_UNKNOWN = "no mapping was found in time, and no limit is known to prevent one: use --effort"


def _lines(problem: Problem, topology: Topology, conflict: Conflict) -> Iterator[str]:
    limits = [_limit(problem, name) for name in conflict.limits]
    if len(limits) == 1:
        yield f"no mapping is feasible: {limits[0]}"
    else:
        yield f"no mapping keeps all of these limits: {'; '.join(limits)}"
    ways = [*_ways(problem, topology, conflict)]
    for number, way in enumerate(ways):
        yield f"{'or' if number else 'it fits'} {way}"
    if conflict.all_of:
        yield f"it fits without {listed(conflict.all_of)}"


def _limit(problem: Problem, name: str) -> str:
    rooms = problem.rooms
    if name == MEMORY:
        needed = sum(unit.size_bytes for unit in problem.units)
        room = sum(one.size_bytes for one in rooms)
        nodes = counted(len(problem.units), "node")
        return (
            f"memory ({nodes} take {size_text(needed)}, at most {size_text(rooms[0].size_bytes)} "
            f"in a cluster and {size_text(room)} in all)"
        )
    if name == CORES:
        needed = sum(map(problem.needed_cores, range(len(problem.units))))
        free = sum(len(one.cores) for one in rooms)
        return f"cores ({needed} are needed, {free} are free in {counted(len(rooms), 'cluster')})"
    return name


def _ways(problem: Problem, topology: Topology, conflict: Conflict) -> Iterator[str]:
    """Yield changes of which each is enough, the nearest first."""
    yield from (f"without {text}" for text in conflict.dropped)
    if conflict.more_cores is not None:
        if not problem.shares_cores:
            yield "with allow_shared_cores: true"
        cores = topology.cores_per_cluster + conflict.more_cores
        yield f"with cores_per_cluster: {cores}"
    if conflict.more_bytes is not None:
        needed = problem.rooms[0].size_bytes + conflict.more_bytes
        yield f"with smem_size: {_smem_size(needed) // MIB}MiB"


def _smem_size(needed: int) -> int:
    """Return the smallest SMEM in MiB that nodes of this size fit into."""
    size = MIB
    while room_for_topic_dsms(size) - Smem(size).head < needed:
        size += MIB
    return size
