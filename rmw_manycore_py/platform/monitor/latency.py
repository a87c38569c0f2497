# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latency of topics while a platform is traced: from publish to the start of the callback."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.trace.events import (
    EndpointId,
    Events,
    Ids,
    Kind,
    Thread,
    Trace,
    endpoint_ids,
    endpoint_in,
)
from rmw_manycore_py.trace.flows import joined, merged
from rmw_manycore_py.trace.pairs import first_of, split_by
from rmw_manycore_py.trace.recorded import looked_at

WINDOW_S = 5.0
# Maximum number of events copied per look.
_MAX_EVENTS = 1 << 20


@dataclass(frozen=True)
class TopicLatency:
    """Quantiles over all subscriptions of a topic, in microseconds."""

    p50_us: float
    p99_us: float
    count: int


def live_latencies(platform: str, state: _transport.TraceState) -> dict[str, TopicLatency]:
    """Return the latency of each topic in the last seconds; recorded events are kept."""
    if not state.started_ns or state.pending > _MAX_EVENTS:
        return {}
    with translate_native_errors():
        trace = looked_at(platform)
    return topic_latencies(trace, time.monotonic_ns() - int(WINDOW_S * 1e9))


def topic_latencies(trace: Trace, since_ns: int = 0) -> dict[str, TopicLatency]:
    """Return the latency of each topic, for messages that arrived since a time."""
    threads = list(trace.threads())
    writes = joined([_published(thread) for _, thread in threads])
    ends = merged(threads, (Kind.RELEASE,))
    ends = ends[ends["time_ns"] >= since_ns]
    publishers = endpoint_in(ends["value"])
    write = first_of((endpoint_ids(writes), writes["number"]), (publishers, ends["number"]))
    found = write >= 0
    taken_us = (ends["time_ns"][found] - writes["time_ns"][write[found]]) / 1e3
    return _by_topic(trace, publishers[found], taken_us)


def _published(thread: Thread) -> Events:
    """Return the writes of a thread, with the start times of their publish calls."""
    chosen = thread.events[np.isin(thread.events["kind"], (Kind.PUBLISH_BEGIN, Kind.WRITE))]
    rows = np.flatnonzero(chosen["kind"] == Kind.WRITE)
    begins = np.maximum(rows - 1, 0)
    is_begin = chosen["kind"][begins] == Kind.PUBLISH_BEGIN
    writes: Events = chosen[rows]
    writes["time_ns"] = np.where(is_begin, chosen["time_ns"][begins], writes["time_ns"])
    return writes


def _by_topic(
    trace: Trace, publishers: Ids, taken_us: NDArray[np.float64]
) -> dict[str, TopicLatency]:
    samples: dict[str, list[NDArray[np.float64]]] = {}
    for own in split_by(publishers):
        name = _topic_name(trace, int(publishers[own[0]]))
        if name is not None:
            samples.setdefault(name, []).append(taken_us[own])
    return {name: _quantiles(np.concatenate(parts)) for name, parts in samples.items()}


def _topic_name(trace: Trace, publisher: EndpointId) -> str | None:
    named = trace.endpoints.get(publisher)
    return named.topic if named is not None and named.role == "topic" else None


def _quantiles(samples_us: NDArray[np.float64]) -> TopicLatency:
    p50, p99 = np.quantile(samples_us, (0.5, 0.99)).tolist()
    return TopicLatency(p50, p99, len(samples_us))
