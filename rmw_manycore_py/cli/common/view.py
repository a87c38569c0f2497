# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Read-only view of a platform as plain data, without joining it."""

from __future__ import annotations

from collections.abc import Iterable

from rmw_manycore_py.cli.common.rows import Row, copies_of, counters_row
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import EndpointInfo, NodeInfo, ProcessInfo
from rmw_manycore_py.native.enums import LOSSES
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.native.platforms import running_text
from rmw_manycore_py.ros.names import full_node_name, is_hidden


def platform_names() -> list[str]:
    """Return the names of this user's platforms, dead ones included."""
    with translate_native_errors():  # e.g. permission denied
        return _transport.platforms()


def require_platform(name: str) -> None:
    """Raise ManycoreError, naming the platforms that run, if there is no such platform."""
    names = platform_names()
    if name not in names:
        raise ManycoreError(f"no platform '{name}'; {running_text(names, ' (--platform)')}")


def open_platform(name: str) -> _transport.Platform:
    """Return the view of a platform; raise ManycoreError, naming the others, if it is missing."""
    require_platform(name)
    with translate_native_errors():
        return _transport.Platform(name)


def endpoints_on(platform: str) -> list[EndpointInfo]:
    """Return all publishers and subscriptions of a platform."""
    with open_platform(platform) as opened:
        return opened.endpoints()


def losses(endpoints: Iterable[EndpointInfo]) -> list[Row]:
    """Return the non-zero counters of lost messages of each endpoint."""
    return [
        {"node": _owner(e), "topic": e.topic, "counter": counter, "count": count}
        for e in endpoints
        for counter, count in counters_row(e.counters).items()
        if counter in LOSSES and count
    ]


def superseded(endpoints: Iterable[EndpointInfo]) -> list[Row]:
    """Return the number of superseded messages of each endpoint that has any."""
    return [
        {"node": _owner(e), "topic": e.topic, "count": e.counters.superseded}
        for e in endpoints
        if e.counters.superseded
    ]


def copies(endpoints: Iterable[EndpointInfo]) -> list[Row]:
    """Return how often each endpoint with large messages copies them, and what readers hold."""
    return [
        {
            "node": _owner(e),
            "topic": e.topic,
            "kind": e.kind,
            "copies_per_message": copies_of(e.counters),
            "held_bytes": e.held_bytes,
        }
        for e in endpoints
        if e.held_bytes or copies_of(e.counters) is not None
    ]


def full_name(node: NodeInfo) -> str:
    """Return a node's fully qualified name."""
    return full_node_name(node.namespace, node.name)


def topics(endpoints: Iterable[EndpointInfo], *, hidden: bool = False) -> list[Row]:
    """Return a row per topic: name, types, and endpoint counts."""
    rows: dict[str, Row] = {}
    for endpoint in endpoints:
        if endpoint.role != "topic" or (is_hidden(endpoint.topic) and not hidden):
            continue
        row = rows.setdefault(
            endpoint.topic,
            {"name": endpoint.topic, "types": [], "publishers": 0, "subscriptions": 0},
        )
        if endpoint.type not in row["types"]:
            row["types"].append(endpoint.type)
        row[f"{endpoint.kind}s"] += 1
    return [rows[name] for name in sorted(rows)]


def services(endpoints: Iterable[EndpointInfo], *, hidden: bool = False) -> list[Row]:
    """Return a row per service: name, types, and server and client counts."""
    rows: dict[str, Row] = {}
    for endpoint in endpoints:
        if endpoint.role != "request" or (is_hidden(endpoint.topic) and not hidden):
            continue
        name = endpoint.topic
        row = rows.setdefault(name, {"name": name, "types": [], "servers": 0, "clients": 0})
        if endpoint.type not in row["types"]:
            row["types"].append(endpoint.type)
        row["servers" if endpoint.kind == "subscription" else "clients"] += 1
    return [rows[name] for name in sorted(rows)]


def actions(endpoints: Iterable[EndpointInfo]) -> list[Row]:
    """Return a row per action: name, types, and the nodes that serve and use it."""
    rows: dict[str, Row] = {}
    for endpoint in endpoints:
        if endpoint.role != "request" or not endpoint.topic.endswith(_SEND_GOAL):
            continue
        name = endpoint.topic.removesuffix(_SEND_GOAL)
        row = rows.setdefault(name, {"name": name, "types": [], "servers": [], "clients": []})
        type_name = endpoint.type.removesuffix("_SendGoal")
        if type_name not in row["types"]:
            row["types"].append(type_name)
        nodes = row["servers" if endpoint.kind == "subscription" else "clients"]
        nodes.append({"node": _owner(endpoint), "type": type_name})
    return [rows[name] for name in sorted(rows)]


def endpoints_of_topic(endpoints: Iterable[EndpointInfo], topic: str) -> list[EndpointInfo]:
    """Return the publishers and subscriptions of one topic."""
    return [e for e in endpoints if e.role == "topic" and e.topic == topic]


def node_names(nodes: Iterable[NodeInfo], *, hidden: bool = False) -> list[str]:
    """Return the full names of the nodes."""
    names = map(full_name, nodes)
    return sorted(name for name in names if hidden or not is_hidden(name))


def placed_nodes(
    nodes: Iterable[NodeInfo], processes: Iterable[ProcessInfo], names: set[str]
) -> list[Row]:
    """Return the named nodes with the cluster, core and host CPU of their process."""
    in_slots = {process.slot: process for process in processes}
    rows = []
    for node in nodes:
        process = in_slots.get(node.process)
        if process is not None and full_name(node) in names:
            place = {
                "cluster": process.cluster,
                "core": process.core,
                "host_cpu": process.host_cpu,
                "pid": process.pid,
            }
            rows.append({"node": full_name(node), **place})
    return sorted(rows, key=lambda row: str(row["node"]))


def node_interfaces(endpoints: Iterable[EndpointInfo], node: str, *, hidden: bool = False) -> Row:
    """Return the interfaces of a node, as mappings from names to types."""
    found: Row = {kind: {} for kind in INTERFACES}
    for endpoint in endpoints:
        kind = _INTERFACE_KINDS.get((endpoint.role, endpoint.kind))
        if kind is None or _owner(endpoint) != node:
            continue
        name, type_name = endpoint.topic, endpoint.type
        if name.endswith(_SEND_GOAL) and kind in _ACTION_KINDS:
            action = type_name.removesuffix("_SendGoal")
            found[_ACTION_KINDS[kind]][name.removesuffix(_SEND_GOAL)] = action
        if hidden or not is_hidden(name):
            found[kind][name] = type_name
    return {kind: dict(sorted(found[kind].items())) for kind in INTERFACES}


def _owner(endpoint: EndpointInfo) -> str:
    return full_node_name(endpoint.node_namespace, endpoint.node_name)


INTERFACES = (
    "subscribers",
    "publishers",
    "service_servers",
    "service_clients",
    "action_servers",
    "action_clients",
)
_SEND_GOAL = "/_action/send_goal"
# A service is a pair of topics; both ends always have the request topic.
_INTERFACE_KINDS = {
    ("topic", "subscription"): "subscribers",
    ("topic", "publisher"): "publishers",
    ("request", "subscription"): "service_servers",
    ("request", "publisher"): "service_clients",
}
_ACTION_KINDS = {"service_servers": "action_servers", "service_clients": "action_clients"}
