# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The routes of this machine: pairs of CPUs, by what they have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.machine.sysfs import cpus_of_list

SAME_CPU, SIBLINGS, SAME_L3 = "same CPU", "sibling", "same L3"
SAME_NODE, OTHER_NODE = "same NUMA node", "other NUMA node"
_SYSTEM = Path("/sys/devices/system/cpu")


@dataclass(frozen=True)
class Placement:
    """The CPUs of sender, receiver and UC, which has the sender's only where there is no other."""

    sender: int
    receiver: int
    uc: int


def routes(cpus: Sequence[int], system: Path = _SYSTEM) -> dict[str, Placement]:
    """Return a placement for each kind of route that these CPUs have, the shortest first."""
    first, *others = sorted(cpus)
    found = {SAME_CPU: first}
    for other in others:
        found.setdefault(_kind(first, other, system), other)
    order = (SAME_CPU, SIBLINGS, SAME_L3, SAME_NODE, OTHER_NODE)
    return {kind: placement(first, found[kind], cpus) for kind in order if kind in found}


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


def _kind(one: int, other: int, system: Path) -> str:
    if other in _list(system / f"cpu{one}/topology/thread_siblings_list"):
        return SIBLINGS
    if other in _list(system / f"cpu{one}/cache/index3/shared_cpu_list"):
        return SAME_L3
    nodes = [sorted(p.name for p in (system / f"cpu{cpu}").glob("node*")) for cpu in (one, other)]
    return SAME_NODE if nodes[0] == nodes[1] else OTHER_NODE


def _list(file: Path) -> tuple[int, ...]:
    try:
        return cpus_of_list(file.read_text())
    except OSError:
        return ()
