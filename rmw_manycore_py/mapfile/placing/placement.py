# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The placement: a mapfile with everything found, ready to be run or written out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rmw_manycore_py.routes import DIRECTIONS, Direction, Route
from rmw_manycore_py.scheduling import Scheduling
from rmw_manycore_py.topology import Core, Topology


@dataclass(frozen=True)
class PlacedComponent:
    """A node that a container loads, as the request for it has it."""

    package: str
    plugin: str
    name: str
    namespace: str
    parameters: Mapping[str, Any]
    remappings: tuple[tuple[str, str], ...]
    extra_arguments: Mapping[str, Any]


@dataclass(frozen=True)
class LaunchRules:
    """What a launch file or a mapfile wants of a node besides its command line.

    It starts `delay_s` after the others, or after the node `after` has started or ended; it is
    started again up to `max_respawns` times (below 0: always) unless `respawn_delay_s` is None.
    """

    after: str | None = None
    after_exit: bool = False
    delay_s: float = 0.0
    respawn_delay_s: float | None = None
    max_respawns: int = 0
    ends_run: bool = False
    transitions: tuple[int, ...] = ()
    components: tuple[PlacedComponent, ...] = ()


NO_RULES = LaunchRules()


@dataclass(frozen=True)
class PlacedNode:
    """A node on its core; `env` is what is set on top of the caller's environment."""

    name: str
    full_name: str
    cluster: int
    core: int
    host_cpu: int
    argv: list[str]
    env: dict[str, str]
    cwd: Path
    program: tuple[str, ...]
    ros_arguments: tuple[str, ...]
    parameters: Mapping[str, Any]
    param_files: tuple[Path, ...]
    publish: Mapping[str, str]
    subscribe: Mapping[str, str]
    workers: tuple[tuple[Core, int], ...]  # with the host CPU of each
    rules: LaunchRules = NO_RULES
    terminal: bool = False
    scheduling: Scheduling | None = None

    @property
    def place(self) -> Core:
        """Cluster and core."""
        return Core(self.cluster, self.core)


@dataclass(frozen=True)
class TopicEntry:
    """A row of the topic table (Fig. 7); without a size its topic DSM grows as needed."""

    id: int
    name: str
    type: str | None
    topic_dsm_size: int | None
    publishers: tuple[PlacedNode, ...]
    subscribers: tuple[PlacedNode, ...]

    @property
    def publisher_clusters(self) -> tuple[int, ...]:
        """The clusters that hold a topic DSM of this topic."""
        return tuple(sorted({node.cluster for node in self.publishers}))

    @property
    def receiver_clusters(self) -> tuple[int, ...]:
        """The clusters whose receive thread is told of each message."""
        return tuple(sorted({node.cluster for node in self.subscribers}))

    @property
    def receiver_mask(self) -> int:
        """The same as bits: bit 0 is cluster 1."""
        return sum(1 << (cluster - 1) for cluster in self.receiver_clusters)


@dataclass(frozen=True)
class ClusterMemory:
    """Local memory of a cluster and what fixed topic DSMs take of it, in bytes."""

    cluster: int
    smem_size: int
    topic_dsms: Mapping[str, int]

    @property
    def used(self) -> int:
        """Bytes that the topic DSMs of fixed size take."""
        return sum(self.topic_dsms.values())


@dataclass(frozen=True)
class BridgePlacement:
    """What crosses the platform's border, and the inward and outward core of each lane.

    Without host CPUs its processes run on all that the run may use.
    """

    routes: tuple[Route, ...]
    cores: tuple[tuple[Core, Core], ...]
    host_cpus: tuple[int, ...] = ()

    def core(self, direction: Direction, lane: int) -> Core:
        """Return where a process of the bridge runs."""
        return self.cores[lane][DIRECTIONS.index(direction)]


@dataclass(frozen=True)
class Placement:
    """A platform and what runs on it."""

    name: str
    topology: Topology
    nodes: tuple[PlacedNode, ...]
    topics: tuple[TopicEntry, ...]
    memory: tuple[ClusterMemory, ...]
    host_cpus: Mapping[Core, int]
    bridge: BridgePlacement | None
    notices: tuple[str, ...]
