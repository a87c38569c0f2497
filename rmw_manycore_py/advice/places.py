# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cores and host CPUs of units whose clusters are chosen."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.advice.problem import Clusters, Problem
from rmw_manycore_py.process.scheduling import Scheduling

# Extra load, in CPUs, that a hot-chain unit counts for when other units choose a core.
_HOT_LOAD = 0.5
# Lowest priority of the hot chain, above what scripts and drivers set; it rises towards the end.
_FIRST_PRIORITY = 10


@dataclass(frozen=True)
class Place:
    """Where a node of a mapfile runs; None leaves the key out of the mapfile."""

    cluster: int
    core: int | None = None
    host_cpu: int | None = None
    scheduling: Scheduling | None = None


def places_of(
    problem: Problem, clusters: Clusters, cpus: Sequence[int], *, in_real_time: bool
) -> dict[str, Place]:
    """Return the place of each node.

    :param cpus: host CPUs that the nodes share; empty where each core has its own.
    :param in_real_time: whether the hot chain comes before other nodes on its CPUs.
    """
    cores = _cores(problem, clusters)
    everything = range(len(problem.units))
    host_cpus = _spread(problem, everything, dict.fromkeys(cpus, 0.0)) if cpus else {}
    policies = _policies(problem) if in_real_time else {}
    return {
        unit.name: Place(cluster, cores.get(i), host_cpus.get(i), policies.get(i))
        for i, (unit, cluster) in enumerate(zip(problem.units, clusters, strict=True))
        if not unit.is_bridge
    }


def _cores(problem: Problem, clusters: Clusters) -> dict[int, int]:
    """Return core numbers where the mapfile has any, or where units share cores."""
    found: dict[int, int] = {}
    members: dict[int, list[int]] = defaultdict(list)
    for i, (unit, cluster) in enumerate(zip(problem.units, clusters, strict=True)):
        is_kept = unit.core is not None and cluster == unit.cluster
        if is_kept and (i in problem.fixed or not problem.shares_cores):
            assert unit.core is not None
            found[i] = unit.core
        elif not unit.is_bridge:
            members[cluster].append(i)
    for cluster, own in members.items():
        here = [i for i in found if clusters[i] == cluster]
        taken = {found[i] for i in here}
        free = [core for core in problem.room(cluster).cores if core not in taken]
        if problem.shares_cores:
            workers = sum(problem.units[i].workers for i in (*own, *here))
            bins = dict.fromkeys(free[: len(free) - workers] or free, 0.0)
            found |= _spread(problem, own, bins)
        else:
            explicit = [i for i in own if problem.units[i].core is not None]
            found |= dict(zip(explicit, free, strict=False))
    return found


def _spread(problem: Problem, units: Sequence[int], loads: Mapping[int, float]) -> dict[int, int]:
    """Distribute units over cores or CPUs.

    The hot chain first, each of its units where the fewest of them are; then the others, the
    busiest first, each where the least load is.
    """
    loads = dict(loads)
    crowd: Counter[int] = Counter()
    found = {}
    hot = [i for i in problem.hot if i in units]
    for i in hot:
        chosen = min(loads, key=lambda one: (crowd[one], loads[one], one))
        crowd[chosen] += 1
        loads[chosen] += problem.units[i].load_cpus
        found[i] = chosen
    for chosen, count in crowd.items():
        loads[chosen] += _HOT_LOAD * count / max(len(hot), 1)
    for i in sorted(set(units) - set(hot), key=lambda i: (-problem.units[i].load_cpus, i)):
        if problem.units[i].is_bridge:
            continue
        chosen = min(loads, key=lambda one: (loads[one], one))
        loads[chosen] += problem.units[i].load_cpus
        found[i] = chosen
    return found


def _policies(problem: Problem) -> dict[int, Scheduling]:
    """Return fifo for the hot chain: a node nearer to its end preempts the others."""
    return {
        unit: Scheduling("fifo", min(_FIRST_PRIORITY + rank, 99))
        for rank, unit in enumerate(problem.hot)
        if not problem.units[unit].is_bridge
    }
