# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latency of topics while a platform is traced: from publish to the callback's begin."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py import _transport
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.trace.events import EndpointId, Events, Kind, Thread, Trace, endpoint_id
from rmw_manycore_py.trace.flows import merged
from rmw_manycore_py.trace.recorded import looked_at

WINDOW_S = 5.0
# Copying more than this for each look would cost more than it tells.
_MAX_EVENTS = 1 << 20

_Keys = NDArray[np.uint64]


@dataclass(frozen=True)
class TopicLatency:
    """Quantiles over all subscriptions of a topic, in microseconds."""

    p50_us: float
    p99_us: float
    count: int


def live_latencies(platform: str, state: _transport.TraceState) -> dict[str, TopicLatency]:
    """Return the latency of each topic in the last seconds; what is recorded stays to be saved."""
    if not state.started_ns or state.pending > _MAX_EVENTS:
        return {}
    with translate_native_errors():
        trace = looked_at(platform)
    return topic_latencies(trace, time.monotonic_ns() - int(WINDOW_S * 1e9))


def topic_latencies(trace: Trace, since_ns: int = 0) -> dict[str, TopicLatency]:
    """Return the latency of each topic, of the messages that arrived since then."""
    threads = list(trace.threads())
    begins = np.concatenate([_published(thread) for _, thread in threads] or [np.empty(0)])
    ends = merged(threads, (Kind.RELEASE,))
    ends = ends[ends["time_ns"] >= since_ns] if len(ends) else ends
    if not len(begins) or not len(ends):
        return {}
    publisher_slots = ends["value"] & 0xFFFF_FFFF
    incarnations = ends["value"] >> np.uint64(32) & np.uint64(0xFFFF)
    end_keys = _keys(publisher_slots, incarnations, ends["number"])
    begin_keys = _keys_of(begins)
    order = np.argsort(begin_keys, kind="stable")
    place = np.minimum(np.searchsorted(begin_keys, end_keys, sorter=order), len(order) - 1)
    match = order[place]
    found = begin_keys[match] == end_keys
    taken_us = (ends["time_ns"] - begins["time_ns"][match])[found] / 1e3
    return _by_topic(trace, begins[match[found]], taken_us)


def _published(thread: Thread) -> Events:
    """Return the writes of a thread, each at the time its publish began."""
    chosen = thread.events[np.isin(thread.events["kind"], (Kind.PUBLISH_BEGIN, Kind.WRITE))]
    rows = np.flatnonzero(chosen["kind"] == Kind.WRITE)
    begins = np.maximum(rows - 1, 0)
    is_begin = chosen["kind"][begins] == Kind.PUBLISH_BEGIN
    writes: Events = chosen[rows]
    writes["time_ns"] = np.where(is_begin, chosen["time_ns"][begins], writes["time_ns"])
    return writes


def _keys_of(events: Events) -> _Keys:
    return _keys(events["endpoint"], events["incarnation"], events["number"])


def _keys(slots: Events, incarnations: Events, numbers: Events) -> _Keys:
    """Return what names a record of the last seconds: the low half of its number will do."""
    slot = slots.astype(np.uint64) << np.uint64(48)
    incarnation = incarnations.astype(np.uint64) << np.uint64(32)
    keys: _Keys = slot | incarnation | numbers.astype(np.uint64) & np.uint64(0xFFFF_FFFF)
    return keys


def _by_topic(
    trace: Trace, begins: Events, taken_us: NDArray[np.float64]
) -> dict[str, TopicLatency]:
    samples: dict[str, list[NDArray[np.float64]]] = {}
    publishers = begins["endpoint"].astype(np.uint64) | begins["incarnation"].astype(
        np.uint64
    ) << np.uint64(32)
    for publisher in np.unique(publishers):
        slot, incarnation = int(publisher) & 0xFFFF_FFFF, int(publisher) >> 32
        name = _topic_name(trace, endpoint_id(slot, incarnation))
        if name is not None:
            samples.setdefault(name, []).append(taken_us[publishers == publisher])
    return {name: _quantiles(np.concatenate(parts)) for name, parts in samples.items()}


def _topic_name(trace: Trace, publisher: EndpointId) -> str | None:
    named = trace.endpoints.get(publisher)
    return named.topic if named is not None and named.role == "topic" else None


def _quantiles(samples_us: NDArray[np.float64]) -> TopicLatency:
    p50, p99 = np.quantile(samples_us, (0.5, 0.99)).tolist()
    return TopicLatency(p50, p99, len(samples_us))
