# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Details of the selected node or topic."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from rmw_manycore_py.picture.marks import topic_text
from rmw_manycore_py.picture.texts import bytes_text, percent_text, rate_text
from rmw_manycore_py.platform.monitor.graph import Endpoint, Member
from rmw_manycore_py.platform.monitor.sample import (
    BYTES,
    CAPACITY,
    DEADLINES,
    EXPIRED,
    HELD_BYTES,
    LOST,
    MESSAGES,
    QUEUED,
    REFUSED,
    SUPERSEDED,
)
from rmw_manycore_py.platform.monitor.watch import Look

Row = dict[str, Any]
# Of /rosout, parameters and type descriptions.
_EVERY_NODES_TYPES = ("rcl_interfaces/", "type_description_interfaces/")


def node_details(look: Look, name: str) -> Row | None:
    """Return process, placement and endpoints of a node; None if there is no such node."""
    sides = ((look.graph.members, False), (look.dead, True))
    for members, is_dead in sides:
        for member in members:
            if name in member.shown_names:
                return _node(look, name, member, is_dead)
    return None


def topic_details(look: Look, name: str) -> Row | None:
    """Return load and endpoints of a topic; None if there is no such topic."""
    load = look.loads.topics.get(name)
    if load is None:
        return None
    latency = look.latencies.get(name)
    endpoints = look.graph.endpoints_of_topics[name]
    return {
        "name": name,
        "types": sorted({endpoint.type for endpoint in endpoints}),
        "load": topic_text(load, latency),
        "latency": None if latency is None else asdict(latency),
        "endpoints": _endpoints(look, lambda e: e.role == "topic" and e.topic == name),
    }


def _node(look: Look, name: str, member: Member, is_dead: bool) -> Row:
    return {
        "name": name,
        "dead": is_dead,
        "program": member.label,
        "pid": member.pid,
        "cluster": member.cluster,
        "core": member.core,
        "host_cpu": member.host_cpu,
        "cpu": percent_text(look.loads.cpu_share(member.pid)),
        "shared_with": [other for other in member.nodes if other != name],
        "workers": len(look.workers.get(member.pid, ())),
        "endpoints": [] if is_dead else _own_first(look, name, member.slot),
    }


def _own_first(look: Look, node: str, process: int) -> list[Row]:
    """Return the endpoints of a node; what every node has, after its own."""
    rows = _endpoints(look, lambda e: e.node == node and e.process == process)
    return sorted(rows, key=lambda row: row["type"].startswith(_EVERY_NODES_TYPES))


def _endpoints(look: Look, is_wanted: Callable[[Endpoint], bool]) -> list[Row]:
    return [
        _endpoint(look, row, endpoint)
        for row, endpoint in enumerate(look.graph.endpoints)
        if is_wanted(endpoint)
    ]


def _endpoint(look: Look, row: int, endpoint: Endpoint) -> Row:
    loads = look.loads
    counts = loads.after.counts[row]
    changes, seconds = loads.changes[row], loads.seconds or 1.0
    messages, copies = int(changes[MESSAGES]), loads.copies_of(row)
    return {
        "kind": endpoint.kind,
        "role": endpoint.role,
        "topic": endpoint.topic,
        "type": endpoint.type,
        "node": endpoint.node,
        "qos": qos_text(endpoint),
        "rate": rate_text(messages / seconds),
        "size": bytes_text(int(changes[BYTES]) / messages) if messages > 0 else "",
        "queue": f"{counts[QUEUED]}/{counts[CAPACITY]}" if counts[CAPACITY] else "",
        "copies": "" if copies is None else f"{copies:.2g}",
        "held": bytes_text(int(counts[HELD_BYTES])) if counts[HELD_BYTES] else "",
        "lost": int(counts[LOST] + counts[EXPIRED] + counts[REFUSED]),
        "superseded": int(counts[SUPERSEDED]),
        "deadlines_missed": int(counts[DEADLINES]),
    }


def qos_text(endpoint: Endpoint) -> str:
    """Format the QoS of an endpoint; policies that are not the default in full; "" if unknown."""
    qos = endpoint.qos
    if not qos:
        return ""
    kept = "keep all" if qos["history"] == "keep_all" else f"keep last {qos['depth']}"
    words = [qos["reliability"].replace("_", " "), qos["durability"].replace("_", " "), kept]
    for name in ("deadline_ns", "lifespan_ns", "liveliness_lease_ns"):
        value = qos[name]
        if value is not None:
            words.append(f"{name.removesuffix('_ns').replace('_', ' ')} {value / 1e6:g} ms")
    if qos["liveliness"] != "automatic":
        words.append(qos["liveliness"].replace("_", " "))
    return ", ".join(words)
