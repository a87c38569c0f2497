# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The load of a platform: CPU time of its processes, rates of its topics."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py import _transport
from rmw_manycore_py.cli.common.rows import Row

TICKS_PER_S = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class Sample:
    """Everything that only grows, at one moment; loads are the differences of two."""

    time_s: float
    processes: list[_transport.ProcessInfo]
    endpoints: list[_transport.EndpointInfo]
    cpu_s: dict[int, float]


def take_sample(platform: _transport.Platform) -> Sample:
    """Look at a platform once."""
    processes = [process for process in platform.processes() if process.alive]
    threads = [
        c.receive_thread_pid for c in platform.clusters() if c.alive and c.receive_thread_pid
    ]
    cpu_s = {pid: _cpu_time_s(pid) for pid in (*(p.pid for p in processes), *threads)}
    return Sample(time.monotonic(), processes, platform.endpoints(), cpu_s)


def process_loads(before: Sample, after: Sample) -> list[Row]:
    """Return each process with its share of a CPU in percent, the busiest first."""
    processes = {process.pid: process for process in after.processes}
    rows = []
    for pid, cpu_s in after.cpu_s.items():
        used_s = cpu_s - before.cpu_s.get(pid, cpu_s)
        percent = 100 * used_s / (after.time_s - before.time_s)
        rows.append({"pid": pid, **_place(processes.get(pid)), "cpu_percent": round(percent, 1)})
    return sorted(rows, key=lambda row: -row["cpu_percent"])


def _place(process: _transport.ProcessInfo | None) -> Row:
    if process is None:
        return {"cluster": None, "core": None, "host_cpu": None, "label": "(receive thread)"}
    return {
        "cluster": process.cluster,
        "core": process.core,
        "host_cpu": process.host_cpu,
        "label": process.label,
    }


def topic_loads(before: Sample, after: Sample) -> list[Row]:
    """Return each topic with messages and bytes published per second, the largest first.

    `lost` counts what its subscriptions have missed since they exist.
    """
    earlier = {endpoint.gid: endpoint.counters for endpoint in before.endpoints}
    seconds = after.time_s - before.time_s
    rows: dict[str, Row] = {}
    for endpoint in after.endpoints:
        name, counters = endpoint.topic, endpoint.counters
        if endpoint.role != "topic":
            continue
        row = rows.setdefault(
            name, {"topic": name, "messages_per_s": 0.0, "bytes_per_s": 0.0, "lost": 0}
        )
        if endpoint.kind == "subscription":
            row["lost"] += counters.lost
            continue
        old = earlier.get(endpoint.gid)
        messages, size_bytes = (old.messages, old.bytes) if old else (0, 0)
        row["messages_per_s"] += (counters.messages - messages) / seconds
        row["bytes_per_s"] += (counters.bytes - size_bytes) / seconds
    return sorted(rows.values(), key=lambda row: -row["bytes_per_s"])


def _cpu_time_s(pid: int) -> float:
    """Return the CPU time a process has used, proc(5): 14th and 15th field of its stat."""
    with suppress(OSError):
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS_PER_S
    return 0.0
