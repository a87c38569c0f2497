# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Status of platforms as typed rows, read without joining them or keeping them alive."""

from __future__ import annotations

from dataclasses import dataclass

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.enums import LOSSES, EndpointKind, EndpointRole
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.native.platforms import running_text
from rmw_manycore_py.ros.domain import checked_platform, default_platform
from rmw_manycore_py.ros.names import full_node_name, node_names_by_process


@dataclass(frozen=True)
class ClusterStatus:
    """A cluster that a process has joined.

    :param id: counted from 1.
    :param smem_bytes: size of its local memory.
    :param used_bytes: used part of `smem_bytes`.
    :param charged_bytes: part of `used_bytes`: memory of processes outside the segment.
    :param receive_thread_pid: process id of its receive thread; None if none runs.
    :param messages: eMCOS messages that the receive thread has handled.
    """

    id: int
    smem_bytes: int
    used_bytes: int
    charged_bytes: int
    receive_thread_pid: int | None
    messages: int


@dataclass(frozen=True)
class ProcessStatus:
    """A process of a platform.

    :param pid: process id.
    :param cluster: counted from 1.
    :param core: counted from 0 in its cluster; None if it has none.
    :param host_cpu: CPU that it is pinned to; None if it may run on several.
    :param program: program name that the tools show.
    :param nodes: full names of its nodes.
    :param alive: False between its death and its reaping.
    """

    pid: int
    cluster: int
    core: int | None
    host_cpu: int | None
    program: str
    nodes: tuple[str, ...]
    alive: bool


@dataclass(frozen=True)
class EndpointStatus:
    """A publisher or subscription of a topic, or of a service's requests or replies.

    :param kind: ``publisher`` or ``subscription``.
    :param role: ``topic``, ``request`` or ``reply``.
    :param topic: full name; the service's for requests and replies.
    :param type: type name such as ``std_msgs/msg/String``.
    :param node: full name of its node.
    :param cluster: cluster of its process, counted from 1.
    :param pid: process id; None if that process is ending.
    :param matched: endpoints that it is matched with now.
    :param messages: messages published or taken so far.
    :param bytes: their serialized size.
    :param lost: of a subscription: messages overwritten before they were taken.
    :param superseded: of a subscription with KEEP_LAST 1: messages not taken, of whose publisher it
        found a newer one instead.
    :param expired: of a subscription: messages dropped because their lifespan was over.
    :param refused: of a publisher: messages that did not fit into its memory.
    :param dropped: of a publisher: messages that were not transferred to a cluster for want of
        room.
    """

    kind: EndpointKind
    role: EndpointRole
    topic: str
    type: str
    node: str
    cluster: int
    pid: int | None
    matched: int
    messages: int
    bytes: int
    lost: int
    superseded: int
    expired: int
    refused: int
    dropped: int


@dataclass(frozen=True)
class PlatformStatus:
    """A snapshot of a platform.

    :param name: its name.
    :param alive: False for the leftovers of a killed platform; `manycore clean` removes them.
    :param cluster_count: maximum number of clusters.
    :param cores_per_cluster: cores of each of them.
    :param clusters: clusters that a process has joined.
    :param processes: its members.
    :param endpoints: publishers and subscriptions of its members.
    """

    name: str
    alive: bool
    cluster_count: int
    cores_per_cluster: int
    clusters: tuple[ClusterStatus, ...]
    processes: tuple[ProcessStatus, ...]
    endpoints: tuple[EndpointStatus, ...]

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of all nodes, sorted."""
        return tuple(sorted(name for process in self.processes for name in process.nodes))

    @property
    def losses(self) -> tuple[EndpointStatus, ...]:
        """The endpoints that have lost, expired, refused or dropped messages."""
        return tuple(e for e in self.endpoints if any(getattr(e, name) for name in LOSSES))


def platforms() -> tuple[str, ...]:
    """Return the names of this user's platforms, dead ones included.

    :raises ManycoreError: if the directory of platforms cannot be read.
    """
    with translate_native_errors():
        return tuple(_transport.platforms())


def status(platform: str | None = None) -> PlatformStatus:
    """Return a snapshot of a platform.

    :param platform: by default $MANYCORE_PLATFORM, else domain-$ROS_DOMAIN_ID.
    :raises ManycoreError: if there is no such platform, or it is damaged.
    """
    name = default_platform() if platform is None else checked_platform(platform, "platform")
    known = platforms()
    if name not in known:
        raise ManycoreError(f"there is no platform '{name}'; {running_text(known)}")
    with translate_native_errors(f"platform '{name}'"), _transport.Platform(name) as view:
        return _looked_at(view)


def _looked_at(view: _transport.Platform) -> PlatformStatus:
    info, processes = view.info(), view.processes()
    nodes = node_names_by_process(view.nodes())
    pids = {process.slot: process.pid for process in processes}
    return PlatformStatus(
        name=info.name,
        alive=info.alive,
        cluster_count=info.clusters,
        cores_per_cluster=info.cores_per_cluster,
        clusters=tuple(map(_cluster, view.clusters())),
        processes=tuple(_process(one, nodes[one.slot]) for one in processes),
        endpoints=tuple(_endpoint(one, pids.get(one.process)) for one in view.endpoints()),
    )


def _cluster(row: _transport.ClusterInfo) -> ClusterStatus:
    return ClusterStatus(
        id=row.id,
        smem_bytes=row.smem_bytes,
        used_bytes=row.used_bytes,
        charged_bytes=row.charged_bytes,
        receive_thread_pid=row.receive_thread_pid if row.alive else None,
        messages=row.messages,
    )


def _process(row: _transport.ProcessInfo, nodes: list[str]) -> ProcessStatus:
    return ProcessStatus(
        pid=row.pid,
        cluster=row.cluster,
        core=row.core,
        host_cpu=row.host_cpu,
        program=row.label,
        nodes=tuple(sorted(nodes)),
        alive=row.alive,
    )


def _endpoint(row: _transport.EndpointInfo, pid: int | None) -> EndpointStatus:
    counters = row.counters
    return EndpointStatus(
        kind=row.kind,
        role=row.role,
        topic=row.topic,
        type=row.type,
        node=full_node_name(row.node_namespace, row.node_name),
        cluster=row.cluster,
        pid=pid,
        matched=row.matched,
        messages=counters.messages,
        bytes=counters.bytes,
        lost=counters.lost,
        superseded=counters.superseded,
        expired=counters.expired,
        refused=counters.refused,
        dropped=counters.dropped,
    )
