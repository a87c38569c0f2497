# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The placement: a resolved mapfile, ready to be run or written out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from rmw_manycore_py.mapfile.launch_file import LaunchFile
from rmw_manycore_py.mapfile.placing.parameters import GeneratedFile, Source, words_of
from rmw_manycore_py.native.enums import Transfer, ZeroCopy
from rmw_manycore_py.platform.smem import DEFAULT_DEPTH
from rmw_manycore_py.platform.topology import Core, Topology, room_for_topic_dsms
from rmw_manycore_py.platform.transfers import transfer_text
from rmw_manycore_py.process.scheduling import Scheduling, priority_above
from rmw_manycore_py.ros.names import file_stem
from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.route import DIRECTIONS, Direction, Route

PARAMETERS = "parameters"  # directory of generated files, of a run and of `manycore create`


@dataclass(frozen=True)
class PlacedComponent:
    """A component, with the fields of a LoadNode request."""

    package: str
    plugin: str
    name: str
    namespace: str
    parameters: Mapping[str, Any]
    remappings: tuple[tuple[str, str], ...]
    extra_arguments: Mapping[str, Any]


@dataclass(frozen=True)
class LaunchRules:
    """Start and restart rules of a node, from the launch file or mapfile.

    It starts `delay_s` after the others, or after the node `after` has started or ended. It is
    restarted up to `max_respawns` times (negative: unlimited) unless `respawn_delay_s` is None.
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
    """A node on its core.

    :param name: as the mapfile has it.
    :param full_name: with its namespace, as /front/camera.
    :param cluster: counted from 1.
    :param core: counted from 0 in its cluster.
    :param host_cpu: CPU that the node is pinned to.
    :param env: set on top of the caller's environment.
    :param cwd: working directory.
    :param program: command line without ROS arguments.
    :param ros_arguments: what follows `program`, except parameters.
    :param parameters: by name, as far as the user's parameter files do not give them.
    :param parameter_sources: files and values in the order in which rcl reads them.
    :param publish: types of published topics, by full name.
    :param subscribe: types of subscribed topics, by full name.
    :param workers: cores of its workers, each with its host CPU.
    :param rules: when it starts, and whether it is started again.
    :param terminal: whether it has a terminal of its own.
    :param scheduling: policy and priority; None where the node inherits them.
    :param missing: why it cannot run here, in a plan; else empty.
    :param depths: known QoS depths, by ``publish`` or ``subscribe`` and the topic's full name.
    :param has_unknown_topics: whether neither mapfile nor source tell all of its topics.
    """

    name: str
    full_name: str
    cluster: int
    core: int
    host_cpu: int
    env: dict[str, str]
    cwd: Path
    program: tuple[str, ...]
    ros_arguments: tuple[str, ...]
    parameters: Mapping[str, Any]
    parameter_sources: tuple[Source, ...]
    publish: Mapping[str, str]
    subscribe: Mapping[str, str]
    workers: tuple[tuple[Core, int], ...]  # core and host CPU of each
    rules: LaunchRules = NO_RULES
    terminal: bool = False
    scheduling: Scheduling | None = None
    missing: str = ""
    depths: Mapping[tuple[str, str], int] = field(default_factory=dict)
    has_unknown_topics: bool = False

    def depth(self, key: Literal["publish", "subscribe"], topic: str) -> int:
        """Return the QoS depth of an endpoint, by default that of ROS 2."""
        return self.depths.get((key, topic), DEFAULT_DEPTH)

    @property
    def place(self) -> Core:
        """Cluster and core."""
        return Core(self.cluster, self.core)

    @property
    def file_stem(self) -> str:
        """Unique name for files of the node."""
        return file_stem(self.name)

    @property
    def argv(self) -> list[str]:
        """Command line; files that `manycore run` generates have relative paths."""
        return self.command(Path(PARAMETERS))

    @property
    def generated_files(self) -> list[GeneratedFile]:
        """Parameter files that have to be written before the node starts."""
        words = words_of(self.parameter_sources, self.file_stem)
        return [word for word in words if isinstance(word, GeneratedFile)]

    def command(self, directory: Path) -> list[str]:
        """Return the command line with the directory that its generated files are in.

        It is empty for a node that cannot run here.
        """
        if self.missing:
            return []
        words = words_of(self.parameter_sources, self.file_stem)
        given = [str(directory / w.name) if isinstance(w, GeneratedFile) else w for w in words]
        return [*self.program, *self.ros_arguments, *given]


@dataclass(frozen=True)
class TopicEntry:
    """Row of the topic table (Fig. 7); without a size the topic DSM grows on demand."""

    id: int
    name: str
    type: str | None
    topic_dsm_size: int | None
    publishers: tuple[PlacedNode, ...]
    subscribers: tuple[PlacedNode, ...]
    transfer: Transfer = "dsm"
    priority: int = 0
    synchronous: bool = False
    zero_copy: ZeroCopy = "unset"

    @property
    def transfer_text(self) -> str:
        """The transfer with what belongs to it."""
        return transfer_text(self.transfer, self.priority, self.synchronous)

    @property
    def landings(self) -> tuple[tuple[PlacedNode, int], ...]:
        """Each publisher with each other cluster that its messages are transferred to."""
        if self.transfer == "dsm":
            return ()
        return tuple(
            (node, cluster)
            for node in self.publishers
            for cluster in self.receiver_clusters
            if cluster != node.cluster
        )

    @property
    def publisher_clusters(self) -> tuple[int, ...]:
        """Clusters that hold a topic DSM of this topic."""
        return tuple(sorted({node.cluster for node in self.publishers}))

    @property
    def receiver_clusters(self) -> tuple[int, ...]:
        """Clusters whose receive thread is notified of each message."""
        return tuple(sorted({node.cluster for node in self.subscribers}))

    @property
    def receiver_mask(self) -> int:
        """Receiver clusters as a bit mask; bit 0 is cluster 1."""
        return sum(1 << (cluster - 1) for cluster in self.receiver_clusters)


@dataclass(frozen=True)
class ClusterMemory:
    """Local memory of a cluster, and what a run takes of it when its nodes have started, in bytes.

    :param cluster: counted from 1.
    :param smem_size: all of it.
    :param topic_dsms: rings of fixed size, by topic.
    :param nodes: the nodes' own endpoints, and the heads of topic DSMs.
    :param queues: subscriptions of topics with their queues.
    :param growing: topics published here without a fixed size: beyond what `nodes` has of them,
        their rings grow, and large messages take chunks.
    """

    cluster: int
    smem_size: int
    topic_dsms: Mapping[str, int]
    nodes: int = 0
    queues: int = 0
    growing: tuple[str, ...] = ()

    @property
    def used(self) -> int:
        """Bytes used by topic DSMs of fixed size."""
        return sum(self.topic_dsms.values())

    @property
    def total(self) -> int:
        """Bytes used by all."""
        return self.used + self.nodes + self.queues

    @property
    def room(self) -> int:
        """Bytes that `total` may have, so that each topic DSM of fixed size finds its place."""
        return room_for_topic_dsms(self.smem_size)


@dataclass(frozen=True)
class BridgePlacement:
    """Routes of the bridge, and the inward and outward core of each lane.

    If `host_cpus` is empty, its processes run on all CPUs of the run.
    """

    routes: tuple[Route, ...]
    cores: tuple[tuple[Core, Core], ...]
    host_cpus: tuple[int, ...] = ()
    outside: OutsideSettings = field(default_factory=OutsideSettings)

    def core(self, direction: Direction, lane: int) -> Core:
        """Return the core of a bridge process."""
        return self.cores[lane][DIRECTIONS.index(direction)]


@dataclass(frozen=True)
class Placement:
    """A platform and what runs on it.

    :param name: name of the platform.
    :param topology: its clusters and cores, and the SMEM of each cluster in bytes.
    :param nodes: in the order of the mapfile.
    :param topics: topic table, as far as sources and mapfile name topics.
    :param memory: what topic DSMs of fixed size take of each cluster.
    :param host_cpus: host CPU of each core in use, those of receive threads and workers included.
    :param bridge: what crosses to the outside; None where nothing does.
    :param notices: what the user should know, although nothing is wrong.
    :param links: what joins this host's part with those of other hosts: from all of them, and to
        each; none for the whole.
    :param launch: the launch file as it was read.
    """

    name: str
    topology: Topology
    nodes: tuple[PlacedNode, ...]
    topics: tuple[TopicEntry, ...]
    memory: tuple[ClusterMemory, ...]
    host_cpus: Mapping[Core, int]
    bridge: BridgePlacement | None
    notices: tuple[str, ...]
    links: tuple[BridgePlacement, ...] = ()
    launch: LaunchFile | None = None

    @property
    def crossings(self) -> tuple[BridgePlacement, ...]:
        """Everything that leaves the platform or this host's part of it."""
        return (*filter(None, (self.bridge,)), *self.links)

    def receive_priority(self, cluster: int, inherited: Scheduling) -> int:
        """Return the real-time priority of a cluster's receive thread; 0 = none.

        It is one above its most urgent node: else that node's messages would wait behind ordinary
        work, and no message would pass a node that spins on the same CPU.

        :param inherited: scheduling of nodes without their own.
        """
        return priority_above(
            one.scheduling or inherited for one in self.nodes if one.cluster == cluster
        )
