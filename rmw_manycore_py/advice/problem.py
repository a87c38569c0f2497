# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Units to be placed, and their limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

Clusters = tuple[int, ...]  # number of each unit's cluster
ConstraintKind = Literal["fix", "together", "apart"]


@dataclass(frozen=True)
class Unit:
    """What has one place: a node with its components and workers, or the bridge.

    :param load_cpus: CPUs that its callbacks keep busy, on the machine of the profile.
    :param size_bytes: memory that its endpoints take of its cluster.
    :param cluster: where it is in the mapfile.
    :param core: where the mapfile names it.
    :param is_bridge: whether it cannot move, and takes no core of nodes.
    """

    name: str
    cluster: int
    core: int | None = None
    load_cpus: float = 0.0
    size_bytes: int = 0
    workers: int = 0
    is_bridge: bool = False


@dataclass(frozen=True)
class Room:
    """What a cluster has for units."""

    cluster: int
    cores: tuple[int, ...]
    size_bytes: int


@dataclass(frozen=True)
class Flow:
    """Messages of a publisher, and the units that receive them.

    :param landing_bytes: memory that they take in each other cluster that receives them.
    :param is_hot: whether this repeats a part of another flow, for the chain that matters.
    """

    topic: str
    publisher: int
    receivers: frozenset[int]
    messages_per_s: float = 0.0
    bytes_per_s: float = 0.0
    landing_bytes: int = 0
    is_hot: bool = False

    def crossed(self, clusters: Clusters) -> set[int]:
        """Return the other clusters that receive the messages."""
        return {clusters[one] for one in self.receivers} - {clusters[self.publisher]}


@dataclass(frozen=True)
class Constraint:
    """A wish of the user; `text` is as it was given."""

    kind: ConstraintKind
    text: str
    units: tuple[int, ...]

    def holds(self, problem: Problem, clusters: Clusters) -> bool:
        """Return whether a mapping grants the wish."""
        own = [clusters[one] for one in self.units]
        if self.kind == "fix":
            return own == [problem.units[one].cluster for one in self.units]
        return len(set(own)) == (1 if self.kind == "together" else len(own))


@dataclass(frozen=True)
class Problem:
    """Units, room for them, messages between them.

    :param shares_cores: whether several units may have one core.
    """

    units: tuple[Unit, ...]
    rooms: tuple[Room, ...]
    flows: tuple[Flow, ...]
    constraints: tuple[Constraint, ...] = ()
    shares_cores: bool = False

    @property
    def now(self) -> Clusters:
        """The mapping of the mapfile."""
        return tuple(unit.cluster for unit in self.units)

    @property
    def fixed(self) -> frozenset[int]:
        """Units that stay where they are."""
        bridges = (i for i, unit in enumerate(self.units) if unit.is_bridge)
        wished = (i for one in self.constraints if one.kind == "fix" for i in one.units)
        return frozenset([*bridges, *wished])

    @property
    def hot(self) -> tuple[int, ...]:
        """Units of the chain that matters, first publisher first."""
        ends = ((one.publisher, *sorted(one.receivers)) for one in self.flows if one.is_hot)
        return tuple(dict.fromkeys(unit for both in ends for unit in both))

    def needed_cores(self, unit: int) -> int:
        """Return how many free cores of its cluster a unit takes for itself."""
        one = self.units[unit]
        if one.is_bridge:
            return 0
        is_reserved = unit in self.fixed and one.core not in (None, *self.room(one.cluster).cores)
        return one.workers + (0 if self.shares_cores or is_reserved else 1)

    def room(self, cluster: int) -> Room:
        """Return the room of a cluster."""
        return self.rooms[cluster - 1]

    def size_bytes(self, clusters: Clusters) -> Mapping[int, int]:
        """Return the memory in use, by cluster."""
        sizes = dict.fromkeys((room.cluster for room in self.rooms), 0)
        for unit, cluster in zip(self.units, clusters, strict=True):
            sizes[cluster] += unit.size_bytes
        for flow in self.flows:
            for cluster in flow.crossed(clusters):
                sizes[cluster] += flow.landing_bytes
        return sizes

    def loads(self, clusters: Clusters) -> Mapping[int, float]:
        """Return the busy CPUs, by cluster."""
        loads = dict.fromkeys((room.cluster for room in self.rooms), 0.0)
        for unit, cluster in zip(self.units, clusters, strict=True):
            loads[cluster] += unit.load_cpus
        return loads

    def broken(self, clusters: Clusters) -> Iterator[str]:
        """Yield what a mapping violates."""
        for constraint in self.constraints:
            if not constraint.holds(self, clusters):
                yield constraint.text
        sizes = self.size_bytes(clusters)
        for room in self.rooms:
            own = [i for i, cluster in enumerate(clusters) if cluster == room.cluster]
            if sizes[room.cluster] > room.size_bytes:
                yield f"memory of cluster {room.cluster}"
            if sum(map(self.needed_cores, own)) > len(room.cores):
                yield f"cores of cluster {room.cluster}"


@dataclass(frozen=True)
class Traffic:
    """Messages and bytes per second between clusters; a message counts once for each receiver."""

    messages_per_s: float
    bytes_per_s: float
    hot_per_s: float

    @classmethod
    def of(cls, flows: Sequence[Flow], clusters: Clusters) -> Traffic:
        """Return the traffic of a mapping."""
        times = [(one, len(one.crossed(clusters))) for one in flows]
        return cls(
            sum(count * one.messages_per_s for one, count in times if not one.is_hot),
            sum(count * one.bytes_per_s for one, count in times),
            sum(count * one.messages_per_s for one, count in times if one.is_hot),
        )
