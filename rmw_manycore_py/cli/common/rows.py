# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parts of a platform as JSON rows."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.native import _transport
from rmw_manycore_py.platform.copies import copies_per_message
from rmw_manycore_py.ros.qos import policies_of

Row = dict[str, Any]


def platform_row(info: _transport.PlatformInfo) -> Row:
    """Return the row of a platform."""
    return {
        "name": info.name,
        "clusters": info.clusters,
        "cores_per_cluster": info.cores_per_cluster,
        "smem_size": info.smem_bytes,
        "alive": info.alive,
    }


def cluster_row(cluster: _transport.ClusterInfo) -> Row:
    """Return the row of a cluster."""
    return {
        "id": cluster.id,
        "smem_size": cluster.smem_bytes,
        "used": cluster.used_bytes,
        "charged": cluster.charged_bytes,
        "receive_thread_pid": cluster.receive_thread_pid,
        "messages": cluster.messages,
        "notifications": cluster.notifications,
        "alive": cluster.alive,
    }


def process_row(process: _transport.ProcessInfo) -> Row:
    """Return the row of a process, with its cluster and core."""
    return {
        "slot": process.slot,
        "pid": process.pid,
        "cluster": process.cluster,
        "core": process.core,
        "host_cpu": process.host_cpu,
        "label": process.label,
        "alive": process.alive,
    }


def counters_row(counters: _transport.CounterValues) -> dict[str, int]:
    """Return the counters of an endpoint."""
    return {
        "messages": counters.messages,
        "bytes": counters.bytes,
        "lost": counters.lost,
        "superseded": counters.superseded,
        "expired": counters.expired,
        "refused": counters.refused,
        "overwritten": counters.overwritten,
        "dropped": counters.dropped,
        "in_place": counters.in_place,
    }


def copies_of(counters: _transport.CounterValues) -> float | None:
    """Return the copies of a message that an endpoint makes; None of small ones."""
    return copies_per_message(counters.messages, counters.bytes, counters.in_place)


def endpoint_row(endpoint: _transport.EndpointInfo) -> Row:
    """Return the row of a publisher or subscription."""
    return {
        "kind": endpoint.kind,
        "role": endpoint.role,
        "topic": endpoint.topic,
        "type": endpoint.type,
        "type_hash": endpoint.type_hash,
        "gid": endpoint.gid.hex(),
        "node": endpoint.node_name,
        "namespace": endpoint.node_namespace,
        "cluster": endpoint.cluster,
        "process": endpoint.process,
        "qos": policies_of(endpoint.qos),
        "matched": endpoint.matched,
        "counters": counters_row(endpoint.counters),
        "copies_per_message": copies_of(endpoint.counters),
        "held_bytes": endpoint.held_bytes,
        "transfer": endpoint.transfer,
    }
