# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rows of `manycore top`: clusters, nodes, processes and topics."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.cli.common.rows import Row
from rmw_manycore_py.platform.monitor.graph import Member
from rmw_manycore_py.platform.monitor.watch import Look

NODE_ORDERS = {"cpu": "cpu_percent", "cluster": "cluster", "core": "core", "name": "node"}
TOPIC_ORDERS = {
    "rate": "messages_per_s",
    "bytes": "bytes_per_s",
    "queue": "queue_percent",
    "lost": "lost",
    "p99": "p99_us",
    "name": "topic",
}
_ASCENDING = {"cluster", "core", "node", "topic"}


def cluster_rows(look: Look) -> list[Row]:
    """Return a row per cluster: memory and receive thread."""
    rates_hz = look.loads.receive_thread_rates_hz()
    return [
        {
            "cluster": cluster.id,
            "smem_size": cluster.smem_bytes,
            "used": cluster.used_bytes,
            "receive_thread_pid": cluster.receive_thread_pid if cluster.alive else None,
            "cpu_percent": _percent(look, cluster.receive_thread_pid),
            "messages_per_s": round(rates_hz[cluster.id], 1),
        }
        for cluster in look.loads.after.clusters
    ]


def node_rows(look: Look) -> list[Row]:
    """Return a row per node with its placement and the CPU usage of its process, in percent.

    Nodes of one process share this usage; `shared` is their number. A node that died stays listed
    until a node of its name runs again.
    """
    living = [_node_row(look, m, name, "alive") for m in look.graph.members for name in m.nodes]
    return living + [_node_row(look, m, name, "died") for m in look.dead for name in m.nodes]


def _node_row(look: Look, member: Member, name: str, state: str) -> Row:
    return {
        "node": name,
        **_place(member),
        "cpu_percent": _percent(look, member.pid),
        "shared": len(member.nodes),
        "state": state,
    }


def process_rows(look: Look) -> list[Row]:
    """Return a row per process with its CPU usage in percent, busiest first."""
    rows = [
        {**_place(member), "label": member.label, "cpu_percent": _percent(look, member.pid)}
        for member in look.graph.members
    ]
    rows += [
        {
            "pid": cluster.receive_thread_pid,
            "cluster": cluster.id,
            "core": None,
            "host_cpu": None,
            "label": "(receive thread)",
            "cpu_percent": _percent(look, cluster.receive_thread_pid),
        }
        for cluster in look.loads.after.clusters
        if cluster.alive and cluster.receive_thread_pid
    ]
    return sorted(rows, key=lambda row: -float(row["cpu_percent"]))


def topic_rows(look: Look) -> list[Row]:
    """Return a row per topic with its publish rates per second, largest first.

    `lost` counts the messages its current subscriptions have missed, `superseded` those replaced
    by a newer one. `queued` and `capacity` are those of the fullest of its queues for several
    messages, 0 without any. `p99_us` is None unless the platform is traced, `copies` (of a message
    on its way to a subscription) unless messages are large; readers hold `held` bytes.
    """
    rows = []
    for name, load in look.loads.topics.items():
        latency = look.latencies.get(name)
        rows.append(
            {
                "topic": name,
                "messages_per_s": round(load.rate_hz, 2),
                "bytes_per_s": round(load.bytes_per_s, 1),
                "queued": load.queued,
                "capacity": load.capacity,
                "queue_percent": round(100 * load.fill, 1),
                "lost": load.lost,
                "superseded": load.superseded,
                "copies": look.loads.copies.get(name),
                "held": look.loads.held_bytes.get(name, 0),
                "p99_us": None if latency is None else round(latency.p99_us, 1),
            }
        )
    return ordered(rows, "bytes_per_s")


def ordered(rows: Sequence[Row], column: str, *, reverse: bool = False) -> list[Row]:
    """Sort rows by a column: names ascending, figures descending; missing values last."""
    descending = (column not in _ASCENDING) != reverse
    known = [row for row in rows if row[column] is not None]
    unknown = [row for row in rows if row[column] is None]
    return sorted(known, key=lambda row: row[column], reverse=descending) + unknown


def _place(member: Member) -> Row:
    return {
        "pid": member.pid,
        "cluster": member.cluster,
        "core": member.core,
        "host_cpu": member.host_cpu,
    }


def _percent(look: Look, pid: int) -> float:
    return round(100 * look.loads.cpu_share(pid), 1)
