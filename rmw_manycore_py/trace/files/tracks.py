# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How tracks are called and counted in the files for viewers."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.trace.events import EndpointId, Kind, Process, Thread, Trace, endpoint_id
from rmw_manycore_py.trace.flows import merged


@dataclass(frozen=True)
class Counter:
    """A number that changes with time: (time in ns, value)."""

    name: str
    samples: tuple[tuple[int, float], ...]


def core_name(process: Process) -> str:
    """Return what a process runs on."""
    if process.is_receive_thread:
        return "receive thread"
    return "no core" if process.core is None else f"core {process.core}"


def process_name(trace: Trace, process: Process) -> str:
    """Return the nodes of a process, else what the tools call it."""
    if process.is_receive_thread:
        return f"receive thread {process.cluster}"
    own = {trace.node_of(endpoint) for thread in process.threads for endpoint in _acting(thread)}
    return ", ".join(sorted(own)) or process.label


def _acting(thread: Thread) -> set[EndpointId]:
    """Return the endpoints that publish and take in a thread."""
    events = thread.events
    own = events[np.isin(events["kind"], (Kind.PUBLISH_BEGIN, Kind.CLAIM))]
    pairs = np.unique(
        own["endpoint"].astype("u8") | own["incarnation"].astype("u8") << np.uint64(32)
    )
    return {int(pair) for pair in pairs}


def counters_of(trace: Trace) -> list[Counter]:
    """Return the queue length of each subscription, and its losses."""
    queues: dict[EndpointId, list[tuple[int, float]]] = defaultdict(list)
    losses: dict[EndpointId, list[tuple[int, float]]] = defaultdict(list)
    waiting: dict[EndpointId, set[tuple[int, int]]] = defaultdict(set)
    lost: dict[EndpointId, int] = defaultdict(int)
    kinds = (Kind.HINT, Kind.CLAIM, Kind.EXPIRED, Kind.LOST)
    for time_ns, number, value, slot, incarnation, kind in merged(
        list(trace.threads()), kinds
    ).tolist():
        endpoint = endpoint_id(slot, incarnation)
        if kind == Kind.LOST:
            lost[endpoint] += value
            losses[endpoint].append((time_ns, lost[endpoint]))
            continue
        if kind == Kind.HINT:
            waiting[endpoint].add((value, number))
        elif kind == Kind.CLAIM:
            waiting[endpoint].discard((value, number))
        queues[endpoint].append((time_ns, len(waiting[endpoint])))
    named = (("queue", queues), ("lost", losses))
    return [
        Counter(f"{name} {trace.topic_of(endpoint)} {trace.node_of(endpoint)}", tuple(samples))
        for name, found in named
        for endpoint, samples in found.items()
    ]
