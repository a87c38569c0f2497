# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An advice in sentences, and as JSON data."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

from rmw_manycore_py.advice.advising import Advice
from rmw_manycore_py.advice.problem import Clusters, Problem, Traffic
from rmw_manycore_py.advice.ranking import NOW, Candidate, Ranked
from rmw_manycore_py.mapfile.mapping.verdict import rates_text
from rmw_manycore_py.platform.texts import counted, listed, size_text

_MAX_NAMES = 6
_NEARLY_FULL = 0.9  # of a cluster's memory


def sentences(advice: Advice) -> Iterator[str]:
    """Yield what changed and why, what it brings, and what limits it."""
    best = advice.best.candidate
    if best.name == NOW:
        yield f"No better mapping was found among {len(advice.ranking)}: keep the one you have."
    else:
        yield from _moves(advice.problem, best.clusters)
        yield from _host(best)
    yield _traffic(advice)
    yield from _times(advice)
    yield from _limits(advice.problem, best)
    if advice.application.not_profiled:
        names = listed(advice.application.not_profiled, _MAX_NAMES)
        yield f"Not in the profile, so of unknown load: {names}."


def _moves(problem: Problem, clusters: Clusters) -> Iterator[str]:
    moved = [i for i, unit in enumerate(problem.units) if clusters[i] != unit.cluster]
    yield f"{len(moved)} of {counted(len(problem.units), 'node')} move to another cluster."
    by_reason: dict[tuple[int, str], list[str]] = defaultdict(list)
    for i in moved:
        by_reason[clusters[i], _reason(problem, clusters, i)].append(problem.units[i].name)
    for (cluster, reason), names in sorted(by_reason.items()):
        verb = "goes" if len(names) == 1 else "go"
        yield f"{listed(names, _MAX_NAMES)} {verb} to cluster {cluster}{reason}."


def _reason(problem: Problem, clusters: Clusters, unit: int) -> str:
    """Return with which unit of its cluster a unit exchanges most, that it did not before."""
    rates: dict[int, float] = defaultdict(float)
    for flow in problem.flows:
        if flow.is_hot:
            continue
        if flow.publisher == unit:
            for receiver in flow.receivers:
                rates[receiver] += flow.messages_per_s
        elif unit in flow.receivers:
            rates[flow.publisher] += flow.messages_per_s
    near = [other for other in rates if clusters[other] == clusters[unit]]
    far_before = [one for one in near if problem.units[one].cluster != problem.units[unit].cluster]
    partner = max(far_before or near, key=lambda one: (rates[one], -one), default=None)
    if partner is None or not rates[partner]:
        return ", where it has room" if not rates else ", for an even load"
    return f", beside {problem.units[partner].name} ({rates[partner]:.1f} messages/s)"


def _host(best: Candidate) -> Iterator[str]:
    hot = [node for node in best.placement.nodes if node.scheduling is not None]
    if "in real time" in best.name and hot:
        names = listed([node.name for node in hot], _MAX_NAMES)
        yield f"{names} have real-time priorities: they come before all others on their CPUs."


def _traffic(advice: Advice) -> str:
    flows = advice.problem.flows
    before = Traffic.of(flows, advice.problem.now)
    after = Traffic.of(flows, advice.best.candidate.clusters)
    return f"Between clusters: {_rates(before)} before, {_rates(after)} after."


def _rates(traffic: Traffic) -> str:
    return rates_text(traffic.messages_per_s, traffic.bytes_per_s)


def _times(advice: Advice) -> Iterator[str]:
    best, before = advice.best.prediction, advice.before
    if before is None or before is advice.best:
        return
    known = {chain.name: chain for chain in before.prediction.chains}
    pairs = [
        (chain.name, known[chain.name].quantile_us(0.99), chain.quantile_us(0.99))
        for chain in best.chains
        if chain.name in known
    ]
    rows = [(name, a, b) for name, a, b in pairs if a is not None and b is not None]
    if rows:
        name, a, b = max(rows, key=lambda row: row[0].count(" > "))
        place = best.target.name
        yield f"Simulated on {place}, p99 of {name}: {a / 1e3:.2f} ms before, {b / 1e3:.2f} after."


def _limits(problem: Problem, best: Candidate) -> Iterator[str]:
    sizes = problem.size_bytes(best.clusters)
    for room in problem.rooms:
        own = [i for i, cluster in enumerate(best.clusters) if cluster == room.cluster]
        used = sum(map(problem.needed_cores, own))
        if used == len(room.cores) and not problem.shares_cores:
            yield f"All {used} free cores of cluster {room.cluster} are taken."
        if sizes[room.cluster] > _NEARLY_FULL * room.size_bytes:
            taken = f"{size_text(sizes[room.cluster])} of {size_text(room.size_bytes)}"
            yield f"Cluster {room.cluster} is nearly full: {taken}."
    for wish in problem.constraints:
        rate = _torn(problem, best.clusters, wish.units) if wish.kind != "together" else 0.0
        if rate:
            yield f"{wish.text} lets {rate:.1f} messages/s cross."
    if best.is_best:
        yield f"Before the simulation, no mapping is better for: {best.name}."


def _torn(problem: Problem, clusters: Clusters, units: tuple[int, ...]) -> float:
    """Return the messages/s of some units that cross clusters."""
    return sum(
        flow.messages_per_s * len(flow.crossed(clusters))
        for flow in problem.flows
        if not flow.is_hot and (flow.publisher in units or flow.receivers & set(units))
    )


def as_data(advice: Advice) -> dict[str, Any]:
    """Return the advice as JSON data."""
    best = advice.best.candidate
    units = advice.problem.units
    return {
        "sentences": [*sentences(advice)],
        "moves": {
            unit.name: cluster
            for unit, cluster in zip(units, best.clusters, strict=True)
            if unit.cluster != cluster
        },
        "candidates": [_row(advice.problem, one) for one in advice.ranking],
        "not_profiled": advice.application.not_profiled,
        "not_placed": advice.application.not_placed,
    }


def _row(problem: Problem, one: Ranked) -> dict[str, Any]:
    traffic = Traffic.of(problem.flows, one.candidate.clusters)
    return {
        "name": one.candidate.name,
        "score": one.score,
        "incomplete": one.incomplete,
        "is_best": one.candidate.is_best,
        "messages_per_s": traffic.messages_per_s,
        "bytes_per_s": traffic.bytes_per_s,
        "chains": [chain.row() for chain in one.prediction.chains],
    }
