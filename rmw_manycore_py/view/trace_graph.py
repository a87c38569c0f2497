# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Graph of a trace: the processes that it names, and their endpoints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rmw_manycore_py.native.enums import EndpointRole
from rmw_manycore_py.platform.monitor.graph import Endpoint, Graph, Member
from rmw_manycore_py.trace.events import Endpoint as NamedEndpoint
from rmw_manycore_py.trace.events import EndpointId, Process, Trace
from rmw_manycore_py.trace.names import nodes_of

_Key = tuple[bool, str, str, str]  # publishes, role, topic, node
_ROLES: dict[str, EndpointRole] = {"topic": "topic", "request": "request", "reply": "reply"}
_NO_PROCESS = -1  # of a node that neither published nor took


@dataclass(frozen=True)
class TracedGraph:
    """A graph, and which of its endpoints each endpoint of the trace is.

    A node that was restarted is one node, and its endpoints of a kind on a topic are one: a trace
    tells nothing else to know them again by.
    """

    graph: Graph
    rows: dict[EndpointId, int]  # indices into the endpoints of the graph


def traced_graph(trace: Trace) -> TracedGraph:
    """Return the graph of a whole trace."""
    members = list(_members(trace))
    slots = {name: member.slot for member in members for name in member.nodes}
    endpoints: dict[_Key, Endpoint] = {}
    places: dict[_Key, int] = {}
    rows: dict[EndpointId, int] = {}
    for own_id, named in trace.endpoints.items():
        key = (named.is_publisher, named.role, named.topic, named.node)
        if key not in endpoints:
            endpoints[key] = _endpoint(own_id, named, slots.get(named.node, _NO_PROCESS))
            places[key] = len(places)
        rows[own_id] = places[key]
    cores = [member.core for member in members if member.core is not None]
    graph = Graph(
        trace.platform,
        cluster_count=max((process.cluster for process in trace.processes), default=1),
        cores_per_cluster=max(cores, default=-1) + 1,
        smem_bytes=0,
        members=tuple(members),
        endpoints=tuple(endpoints.values()),
    )
    return TracedGraph(graph, rows)


def _members(trace: Trace) -> Iterator[Member]:
    """Yield the processes; of those with the same nodes the last."""
    processes = [process for process in trace.processes if not process.is_receive_thread]
    processes.sort(key=_last_ns)
    nodes = [tuple(nodes_of(trace, process)) for process in processes]
    last = {names: slot for slot, names in enumerate(nodes)}
    for slot, (process, names) in enumerate(zip(processes, nodes, strict=True)):
        if not names or last[names] == slot:
            place = (process.cluster, process.core, process.host_cpu)
            yield Member(slot, process.pid, *place, process.label, names)


def _last_ns(process: Process) -> int:
    return max((int(t.events["time_ns"][-1]) for t in process.threads if len(t.events)), default=0)


def _endpoint(own_id: EndpointId, named: NamedEndpoint, slot: int) -> Endpoint:
    return Endpoint(
        own_id,
        "publisher" if named.is_publisher else "subscription",
        _ROLES[named.role],
        named.topic,
        named.type,
        named.node,
        slot,
        {},
    )
