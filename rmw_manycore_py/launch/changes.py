# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What differs between two placements of a run's nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rmw_manycore_py.mapfile.format.checks import PLACE_VARIABLES
from rmw_manycore_py.mapfile.placing.placement import PlacedNode, Placement
from rmw_manycore_py.platform.topology import WORKER_CPUS

# Fields of a node that only matter when it starts, in words.
_DEFINITION = {
    "program": "program",
    "ros_arguments": "ROS arguments",
    "parameter_sources": "parameters",
    "cwd": "directory",
    "workers": "workers",
    "rules": "launch rules",
    "terminal": "terminal",
    "scheduling": "scheduling",
}
_OF_A_PLACE = {*PLACE_VARIABLES, WORKER_CPUS}


@dataclass(frozen=True)
class Changes:
    """Nodes to restart, each with what changed, to start, and to stop for good."""

    changed: Mapping[str, str]
    added: Mapping[str, str]
    removed: tuple[str, ...]

    @classmethod
    def between(cls, old: Placement, new: Placement) -> Changes:
        """Compare the running placement with the new one."""
        before = {node.name: node for node in old.nodes}
        after = {node.name: node for node in new.nodes}
        common = {name: listed_changes(before[name], after[name]) for name in after.keys() & before}
        return cls(
            changed={name: common[name] for name in after if common.get(name)},
            added={name: str(node.place) for name, node in after.items() if name not in before},
            removed=tuple(name for name in before if name not in after),
        )

    def lines(self) -> Iterator[str]:
        """Yield the changes in words."""
        for name, what in self.changed.items():
            yield f"{name} changes: {what}"
        for name, place in self.added.items():
            yield f"{name} is new: {place}"
        for name in self.removed:
            yield f"{name} is removed"


def listed_changes(old: PlacedNode, new: PlacedNode) -> str:
    """Return what differs between a node and its successor; empty if nothing does."""
    found = []
    if old.place != new.place:
        found.append(f"{old.place} -> {new.place}")
    elif old.host_cpu != new.host_cpu:
        found.append(f"host CPU {old.host_cpu} -> {new.host_cpu}")
    found += [words for key, words in _DEFINITION.items() if getattr(old, key) != getattr(new, key)]
    if _variables(old) != _variables(new):
        found.append("environment")
    return ", ".join(found)


def _variables(node: PlacedNode) -> dict[str, str]:
    return {name: value for name, value in node.env.items() if name not in _OF_A_PLACE}
