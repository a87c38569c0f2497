# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A placement as plain data, for tables and --json."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rmw_manycore_py.mapfile.placing.placement import (
    BridgePlacement,
    ClusterMemory,
    LaunchRules,
    PlacedNode,
    Placement,
    TopicEntry,
)


def as_data(placement: Placement) -> dict[str, Any]:
    """Return all fields of a placement as JSON data."""
    return {
        "platform": placement.name,
        "profile": placement.topology.profile,
        "clusters": [cluster_row(placement, memory) for memory in placement.memory],
        "nodes": [_node(node) for node in placement.nodes],
        "topics": [_topic(topic) for topic in placement.topics],
        "bridge": _bridge(placement.bridge) if placement.bridge else None,
        "notices": list(placement.notices),
    }


def cluster_row(placement: Placement, memory: ClusterMemory) -> dict[str, Any]:
    """Return a cluster and its memory as JSON data."""
    cluster = placement.topology.clusters[memory.cluster - 1]
    host = cluster.host
    of_machine = {"host_cpus": list(host.cpus), "numa_node": host.node} if host else {}
    return {
        "cluster": memory.cluster,
        "cores": cluster.cores,
        "reserved_cores": sorted(cluster.reserved),
        **of_machine,
        "smem_size": memory.smem_size,
        "used": memory.used,
        "topic_dsms": dict(memory.topic_dsms),
        "node_bytes": memory.nodes,
        "queue_bytes": memory.queues,
        "total": memory.total,
        "growing_topics": list(memory.growing),
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
        "missing": node.missing or None,
        "environment": node.env,
        "directory": str(node.cwd),
        "scheduling": asdict(node.scheduling) if node.scheduling else None,
        "terminal": node.terminal,
        **_rules(node.rules),
        "publish": dict(node.publish),
        "subscribe": dict(node.subscribe),
    }


def _rules(rules: LaunchRules) -> dict[str, Any]:
    respawns = rules.respawn_delay_s is not None and rules.max_respawns != 0
    retries = None if rules.max_respawns < 0 else rules.max_respawns
    return {
        "start": {
            "delay_s": rules.delay_s,
            "after": rules.after,
            "on": ("exit" if rules.after_exit else "start") if rules.after else None,
        },
        "respawn": {"delay_s": rules.respawn_delay_s, "max_retries": retries} if respawns else None,
        "ends_run": rules.ends_run,
        "transitions": [_TRANSITIONS.get(number, str(number)) for number in rules.transitions],
        "components": [asdict(component) for component in rules.components],
    }


# Values of lifecycle_msgs/msg/Transition.
_TRANSITIONS = {
    1: "configure",
    2: "cleanup",
    3: "activate",
    4: "deactivate",
    5: "shutdown",
    6: "shutdown",
    7: "shutdown",
}


def rules_in_words(node: PlacedNode) -> list[str]:
    """Describe what `manycore run` does with a node besides starting it at once."""
    data = _rules(node.rules)
    start, respawn, words = data["start"], data["respawn"], []
    if start["delay_s"] or start["after"]:
        what = {"exit": "the end of ", "start": "the start of "}.get(start["on"], "the others")
        after = f"after {what}{start['after'] or ''}"
        delay = f"{start['delay_s']:g} s " if start["delay_s"] else ""
        words.append(f"starts {delay}{after}")
    if respawn:
        often = (
            "" if respawn["max_retries"] is None else f", {respawn['max_retries']} times at most"
        )
        words.append(f"respawned {respawn['delay_s']:g} s after it ends{often}")
    if data["ends_run"]:
        words.append("its end stops the run")
    if data["transitions"]:
        words.append(f"lifecycle: {', '.join(data['transitions'])}")
    words += [f"loads {one.plugin} as {one.name or 'named there'}" for one in node.rules.components]
    if node.scheduling:
        words.append(f"scheduling {node.scheduling}")
    if node.terminal:
        words.append("has a terminal")
    return words


def _topic(topic: TopicEntry) -> dict[str, Any]:
    return {
        "id": topic.id,
        "name": topic.name,
        "type": topic.type,
        "topic_dsm_size": topic.topic_dsm_size,
        "transfer": topic.transfer,
        "priority": topic.priority,
        "synchronous": topic.synchronous,
        "zero_copy": topic.zero_copy,
        "publisher_clusters": list(topic.publisher_clusters),
        "receiver_clusters": list(topic.receiver_clusters),
    }


def _bridge(bridge: BridgePlacement) -> dict[str, Any]:
    return {
        "cores": [[list(core) for core in lane] for lane in bridge.cores],
        "host_cpus": list(bridge.host_cpus),
        "outside": asdict(bridge.outside),
        "routes": [asdict(route) for route in bridge.routes],
    }
