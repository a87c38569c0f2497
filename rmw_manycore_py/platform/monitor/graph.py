# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Graph of a platform: what changes only when a node or endpoint joins or leaves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.enums import EndpointKind, EndpointRole
from rmw_manycore_py.ros.names import full_node_name, node_names_by_process
from rmw_manycore_py.ros.qos import Policies, policies_of

# Topics of every rclpy node; drawing them would clutter the picture.
EVERY_NODES_TOPICS = frozenset(("/rosout", "/parameter_events"))


@dataclass(frozen=True)
class Member:
    """A process of the platform with the names of its nodes."""

    slot: int
    pid: int
    cluster: int
    core: int | None
    host_cpu: int | None
    label: str
    nodes: tuple[str, ...]

    @property
    def shown_names(self) -> tuple[str, ...]:
        """Names of its nodes; without nodes, the label used by the tools."""
        return self.nodes or (f"({self.label})",)


@dataclass(frozen=True)
class Endpoint:
    """A publisher or subscription."""

    id: int  # key of the activity rows
    kind: EndpointKind
    role: EndpointRole
    topic: str
    type: str
    node: str
    process: int
    qos: Policies


@dataclass(frozen=True)
class Graph:
    """Members and endpoints of a platform between two graph changes."""

    platform: str
    cluster_count: int
    cores_per_cluster: int
    smem_bytes: int  # per cluster
    members: tuple[Member, ...]
    endpoints: tuple[Endpoint, ...]

    @cached_property
    def ids(self) -> NDArray[np.uint64]:
        """Endpoint ids, in order."""
        return np.array([endpoint.id for endpoint in self.endpoints], dtype=np.uint64)

    @cached_property
    def endpoints_by_id(self) -> dict[int, Endpoint]:
        """Endpoints by id."""
        return {endpoint.id: endpoint for endpoint in self.endpoints}

    @cached_property
    def is_publisher(self) -> NDArray[np.bool_]:
        """Whether each endpoint is a publisher."""
        return np.array([e.kind == "publisher" for e in self.endpoints], dtype=bool)

    @cached_property
    def topics(self) -> tuple[str, ...]:
        """Topic names, sorted; excludes services."""
        return tuple(sorted({e.topic for e in self.endpoints if e.role == "topic"}))

    @cached_property
    def topic_index(self) -> NDArray[np.intp]:
        """Index into `topics` of each endpoint; one past the end for services."""
        place = {name: index for index, name in enumerate(self.topics)}
        none = len(self.topics)
        return np.array(
            [place[e.topic] if e.role == "topic" else none for e in self.endpoints], dtype=np.intp
        )

    @cached_property
    def endpoints_of_topics(self) -> dict[str, tuple[Endpoint, ...]]:
        """Endpoints by topic."""
        found: dict[str, list[Endpoint]] = {name: [] for name in self.topics}
        for endpoint in self.endpoints:
            if endpoint.role == "topic":
                found[endpoint.topic].append(endpoint)
        return {name: tuple(endpoints) for name, endpoints in found.items()}

    @cached_property
    def drawn_topics(self) -> tuple[str, ...]:
        """Topics with publishers and subscriptions, except those of every node."""
        return tuple(
            name
            for name, endpoints in self.endpoints_of_topics.items()
            if name not in EVERY_NODES_TOPICS and len({e.kind for e in endpoints}) > 1
        )


def read_graph(platform: _transport.Platform, earlier: Graph | None = None) -> Graph:
    """Read members and endpoints of a platform.

    :param earlier: graph of this platform read before; its endpoints that still exist are kept.
    """
    known = {} if earlier is None else earlier.endpoints_by_id
    info = platform.info()
    processes = platform.processes()
    nodes = node_names_by_process(platform.nodes())
    return Graph(
        info.name,
        info.clusters,
        info.cores_per_cluster,
        info.smem_bytes,
        tuple(_member(process, nodes[process.slot]) for process in processes),
        tuple(_endpoint(endpoint, known) for endpoint in platform.endpoints()),
    )


def _member(process: _transport.ProcessInfo, nodes: Sequence[str]) -> Member:
    return Member(
        process.slot,
        process.pid,
        process.cluster,
        process.core,
        process.host_cpu,
        process.label,
        tuple(sorted(nodes)),
    )


def _endpoint(endpoint: _transport.EndpointInfo, known: Mapping[int, Endpoint]) -> Endpoint:
    return known.get(endpoint.id) or Endpoint(
        endpoint.id,
        endpoint.kind,
        endpoint.role,
        endpoint.topic,
        endpoint.type,
        full_node_name(endpoint.node_namespace, endpoint.node_name),
        endpoint.process,
        policies_of(endpoint.qos),
    )
