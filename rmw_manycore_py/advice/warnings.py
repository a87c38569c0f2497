# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Faults of a mapping by its profile, without a search for a better one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from rmw_manycore_py.advice.application import Application
from rmw_manycore_py.advice.problem import Clusters, Problem, Traffic
from rmw_manycore_py.mapfile import Mapfile, Placement
from rmw_manycore_py.mapfile.mapping.verdict import rates_text
from rmw_manycore_py.platform.texts import listed, size_text
from rmw_manycore_py.profile.model import Profile

# Of the messages between clusters: less is not worth a move.
_WORTH = 0.1
_OVERLOADED, _BUSY = 1.0, 0.8  # CPUs of a core
_MAX_NAMES = 5


def warnings_of(mapfile: Mapfile, placement: Placement, profile: Profile) -> Iterator[str]:
    """Yield faults of a mapping, the worst first.

    :raises ManycoreError: if the profile is of another application.
    """
    application = Application(mapfile, placement.nodes, placement.bridge, profile)
    problem = application.problem()
    yield from _loads(problem, placement)
    yield from _memory(problem)
    yield from _moves(problem)
    if application.not_profiled:
        yield f"the profile lacks {listed(application.not_profiled, _MAX_NAMES)}"


def _loads(problem: Problem, placement: Placement) -> Iterator[str]:
    loads: dict[str, float] = defaultdict(float)
    for unit, node in zip(problem.units, placement.nodes, strict=False):
        loads[str(node.place)] += unit.load_cpus
    for place, load in sorted(loads.items(), key=lambda one: -one[1]):
        if load > _BUSY:
            what = "overloaded" if load > _OVERLOADED else "nearly overloaded"
            yield f"{place} is {what}: its callbacks take {load:.0%} of a CPU of the profile"


def _memory(problem: Problem) -> Iterator[str]:
    sizes = problem.size_bytes(problem.now)
    for room in problem.rooms:
        if sizes[room.cluster] > room.size_bytes:
            taken = f"{size_text(sizes[room.cluster])} of {size_text(room.size_bytes)}"
            yield f"cluster {room.cluster} needs {taken} with all endpoints of the profile"


def _moves(problem: Problem) -> Iterator[str]:
    """Yield the move of one node that saves most messages between clusters."""
    now = Traffic.of(problem.flows, problem.now)
    if not now.messages_per_s:
        return
    best, after = None, now
    for unit, clusters in _single_moves(problem):
        traffic = Traffic.of(problem.flows, clusters)
        if traffic.messages_per_s < after.messages_per_s and not [*problem.broken(clusters)]:
            best, after = (unit, clusters[unit]), traffic
    if best is not None and after.messages_per_s <= (1 - _WORTH) * now.messages_per_s:
        name, cluster = problem.units[best[0]].name, best[1]
        before = rates_text(now.messages_per_s, now.bytes_per_s)
        less = rates_text(after.messages_per_s, after.bytes_per_s)
        yield (
            f"{before} cross clusters, {less} with {name} in cluster {cluster}: `manycore advise` "
            "finds more"
        )


def _single_moves(problem: Problem) -> Iterator[tuple[int, Clusters]]:
    """Yield each node in the cluster of another one that it exchanges messages with."""
    now = problem.now
    partners: dict[int, set[int]] = defaultdict(set)
    for flow in problem.flows:
        for receiver in flow.receivers:
            partners[receiver].add(now[flow.publisher])
            partners[flow.publisher].add(now[receiver])
    for unit in sorted(set(partners) - problem.fixed):
        for cluster in sorted(partners[unit] - {now[unit]}):
            yield unit, (*now[:unit], cluster, *now[unit + 1 :])
