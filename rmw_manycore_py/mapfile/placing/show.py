# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A placement as plain data, for tables and for --json."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rmw_manycore_py.mapfile.placing.placement import (
    BridgePlacement,
    PlacedNode,
    Placement,
    TopicEntry,
)


def as_data(placement: Placement) -> dict[str, Any]:
    """Return everything a placement says, as JSON has it."""
    topology = placement.topology
    return {
        "platform": placement.name,
        "profile": topology.profile,
        "clusters": [
            {
                "cluster": memory.cluster,
                "cores": topology.clusters[memory.cluster - 1].cores,
                "reserved_cores": sorted(topology.clusters[memory.cluster - 1].reserved),
                "smem_size": memory.smem_size,
                "used": memory.used,
                "topic_dsms": dict(memory.topic_dsms),
            }
            for memory in placement.memory
        ],
        "nodes": [_node(node) for node in placement.nodes],
        "topics": [_topic(topic) for topic in placement.topics],
        "bridge": _bridge(placement.bridge) if placement.bridge else None,
        "notices": list(placement.notices),
    }


def _node(node: PlacedNode) -> dict[str, Any]:
    return {
        "name": node.name,
        "full_name": node.full_name,
        "cluster": node.cluster,
        "core": node.core,
        "host_cpu": node.host_cpu,
        "workers": [
            {"cluster": core.cluster, "core": core.core, "host_cpu": cpu}
            for core, cpu in node.workers
        ],
        "command": node.argv,
        "environment": node.env,
        "directory": str(node.cwd),
        "publish": dict(node.publish),
        "subscribe": dict(node.subscribe),
    }


def _topic(topic: TopicEntry) -> dict[str, Any]:
    return {
        "id": topic.id,
        "name": topic.name,
        "type": topic.type,
        "topic_dsm_size": topic.topic_dsm_size,
        "publisher_clusters": list(topic.publisher_clusters),
        "receiver_clusters": list(topic.receiver_clusters),
    }


def _bridge(bridge: BridgePlacement) -> dict[str, Any]:
    return {
        "cores": [[list(core) for core in lane] for lane in bridge.cores],
        "host_cpus": list(bridge.host_cpus),
        "routes": [asdict(route) for route in bridge.routes],
    }
