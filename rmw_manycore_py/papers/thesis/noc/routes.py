# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The routes of this machine: pairs of CPUs, by what they have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.machine.clusters import clusters_of
from rmw_manycore_py.platform.machine.pairs import nearest_pairs
from rmw_manycore_py.platform.machine.sysfs import SYSTEM, Cpu, read_cpus


@dataclass(frozen=True)
class Placement:
    """The CPUs of sender, receiver and UC, which has the sender's only where there is no other."""

    sender: int
    receiver: int
    uc: int


def routes(cpus: Sequence[int], system: Path = SYSTEM) -> dict[str, Placement]:
    """Return a placement for each kind of route that these CPUs have, the shortest first."""
    shown = {cpu.number: cpu for cpu in read_cpus(system)}
    usable = [shown.get(cpu, Cpu(cpu, (cpu,))) for cpu in sorted(cpus)]
    pairs = nearest_pairs(usable, clusters_of(usable))
    return {kind: placement(*pair, cpus) for kind, pair in pairs.items()}


def placement(sender: int, receiver: int, cpus: Sequence[int]) -> Placement:
    """Return the placement with the UC on a CPU of its own, or else beside the receiver."""
    free = [cpu for cpu in sorted(cpus) if cpu not in (sender, receiver)]
    others = free or [cpu for cpu in sorted(cpus) if cpu != sender]
    return Placement(sender, receiver, others[0] if others else sender)


def chosen(text: str, cpus: Sequence[int]) -> dict[str, Placement]:
    """Return the placement that a user gives: sender, receiver and perhaps UC.

    :raises ManycoreError: for anything but two or three CPUs of this process.
    """
    try:
        given = [int(word) for word in text.split(",")]
    except ValueError:
        given = []
    outside = [cpu for cpu in given if cpu not in cpus]
    if len(given) not in (2, 3) or outside:
        expected = f"sender,receiver[,UC] of the host CPUs {', '.join(map(str, sorted(cpus)))}"
        raise ManycoreError(f"--cpus {text}: expected {expected}", EXIT_BAD_INPUT)
    found = placement(given[0], given[1], cpus)
    return {f"CPU {text}": Placement(*given) if len(given) == 3 else found}


def main_route(found: Mapping[str, Placement]) -> str:
    """Return the nearest route between two CPUs, or the only one."""
    apart = [name for name, cpus in found.items() if cpus.sender != cpus.receiver]
    return (apart or list(found))[0]
