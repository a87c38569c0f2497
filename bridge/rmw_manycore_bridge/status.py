# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Status of a platform's bridge, from the counter files of its processes."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rmw_manycore_bridge.counters import FIELDS, CounterFile, is_locked
from rmw_manycore_bridge.datagrams import receive_buffer_errors, socket_drops
from rmw_manycore_bridge.lanes import LaneTable, name_of
from rmw_manycore_py.native import _transport
from rmw_manycore_py.platform.topology import HostCpu, as_host_cpu
from rmw_manycore_py.routes.outside import engine_and_peer

_OF_OWNER = ("state", "latched", "latency_max_ns")
_INTERNAL = ("latency_ns", "load_ppm", "window_ns", "window_busy_ns")
_STEM, _LANE = 1, 2  # parts of bridge-<stem>-<lane>
_DASHES = 2
_Key = tuple[Any, ...]


def status(platform: str) -> list[dict[str, Any]]:
    """Return a row per route of a platform's bridge, summed over lanes."""
    owners: dict[str, dict[str, int]] = {}
    merged: dict[_Key, dict[str, Any]] = {}
    for row in _rows(platform):
        names = ("stem", "kind", "inside", "outside", "domain")
        key = tuple(row[name] for name in names)
        lane, stem = row["lane"], row.pop("stem")
        if row["kind"] == "topic":
            if stem not in owners:
                owners[stem] = LaneTable.of(platform, stem).owners()
            lane = owners[stem].get(name_of(row), lane)
        is_owner = row.pop("process_lane") == lane
        row["lane"] = lane
        merged[key] = _sum(merged[key], row, is_owner) if key in merged else row
    for row in merged.values():
        latency_ns, messages = row["latency_ns"], row["messages"]
        row["latency_mean_ns"] = latency_ns // messages if messages else None
        for name in _INTERNAL:
            del row[name]
    return list(merged.values())


def topic_loads(platform: str, stem: str) -> dict[int, list[tuple[float, bool]]]:
    """Return by lane the CPU usage of each topic and whether it may move."""
    found = {}
    for path in _files(platform, f"bridge-{stem}-*"):
        if path.name.count("-") > _DASHES:  # topics of patterns do not move
            continue
        counters = CounterFile.open(path)
        if counters is not None and is_locked(path):
            lane = _lane_of(path)
            found[lane] = [(row.load, not row.is_latched) for row in counters.rows]
    return found


def _rows(platform: str) -> Iterator[dict[str, Any]]:
    for path in _files(platform, "bridge-*"):
        counters = CounterFile.open(path)
        if counters is None:
            continue
        stem = path.name.split("-")[_STEM]
        engine, peer = engine_and_peer(stem)
        process = {
            "stem": stem,
            "engine": engine,
            "peer": peer,
            "process_lane": _lane_of(path),
            "pid": counters.pid,
            "alive": is_locked(path),
            "host_cpu": _host_cpu(counters.pid),
            "socket_drops": socket_drops(counters.pid),
            "receive_buffer_errors": receive_buffer_errors(counters.pid),
        }
        for route, row in zip(counters.routes, counters.rows, strict=True):
            yield {**route, **process, **row.as_dict(), "load": row.load}


def _lane_of(path: Path) -> int:
    return int(path.name.split("-")[_LANE])


def _host_cpu(pid: int) -> HostCpu:
    """Return the CPUs a process is pinned to; None if unpinned or ended."""
    try:
        cpus = os.sched_getaffinity(pid)
    except ProcessLookupError:
        return None
    return as_host_cpu(() if len(cpus) == os.cpu_count() else tuple(sorted(cpus)))


def _files(platform: str, pattern: str) -> list[Path]:
    try:
        return sorted(Path(_transport.platform_directory(platform)).glob(pattern))
    except FileNotFoundError:  # the last process is removing the directory
        return []


def _sum(one: dict[str, Any], other: dict[str, Any], other_is_owner: bool) -> dict[str, Any]:
    """Return the owner's row with the counters of both added up."""
    total = dict(other if other_is_owner else one)
    for name in FIELDS:
        if name not in _OF_OWNER:
            total[name] = one[name] + other[name]
    total["latency_max_ns"] = max(one["latency_max_ns"], other["latency_max_ns"])
    return total
