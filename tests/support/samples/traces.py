# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traces with known times, in the layout that nodes write."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import (
    EVENT,
    NO_ENDPOINT,
    Endpoint,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_id,
)
from rmw_manycore_py.trace.latency import ChainLatency, latencies

US = 1000
CAMERA, FILTER_IN, FILTER_OUT, SINK = 1, 2, 3, 4
NAMES = {
    CAMERA: (True, "/image", "/camera"),
    FILTER_IN: (False, "/image", "/filter"),
    FILTER_OUT: (True, "/small", "/filter"),
    SINK: (False, "/small", "/sink"),
}
INCARNATION = 1 << 16 | 5  # events contain its low bits


def event(time_us: int, kind: Kind, slot: int, number: int = 0, value: int = 0):
    return (time_us * US, number, value, slot, 0 if slot == NO_ENDPOINT else 5, kind)


def publish(at_us: int, slot: int, number: int) -> list:
    return [
        event(at_us, Kind.PUBLISH_BEGIN, slot, 0, 64),
        event(at_us + 1, Kind.SERIALIZE_BEGIN, slot, number),
        event(at_us + 2, Kind.WRITE, slot, number, 60),
        event(at_us + 5, Kind.PUBLISH_END, slot, number),
    ]


def take(at_us: int, slot: int, number: int, publisher: int) -> list:
    origin = endpoint_id(publisher, INCARNATION) | 1 << 48  # the whole incarnation
    return [
        event(at_us, Kind.CLAIM, slot, number, origin),
        event(at_us + 3, Kind.RELEASE, slot, number, origin),
    ]


def wait(begin_us: int, end_us: int) -> list:
    none = NO_ENDPOINT
    return [event(begin_us, Kind.WAIT_BEGIN, none), event(end_us, Kind.WAIT_END, none, 0, 1)]


def process(cluster: int, rows: list, *, lost: int = 0, is_receive_thread: bool = False) -> Process:
    thread = Thread(100 + cluster, "python", np.array(rows, EVENT), lost)
    return Process(
        cluster, cluster, None if is_receive_thread else 2, 0, "node", is_receive_thread, True,
        (thread,), 0,
    )  # fmt: skip


def example(slower_us: int = 0, rounds: int = 8, *, twice: bool = False) -> Trace:
    """Camera, filter and sink in three clusters; a receive thread notifies the sink's cluster."""
    camera, filtering, sink, told = [], [], [], []
    for i in range(1, rounds + 1):
        t = 10_000 * i
        camera += publish(t, CAMERA, i)
        told.append(event(t + 10, Kind.RECEIVE, CAMERA, i, 2))
        told.append(event(t + 11, Kind.HINT, FILTER_IN, i, endpoint_id(CAMERA, INCARNATION)))
        filtering += wait(t - 100, t + 20) + take(t + 30, FILTER_IN, i, CAMERA)
        filtering += publish(t + 133 + slower_us, FILTER_OUT, 2 * i)
        sink += wait(t - 100, t + 300) + take(t + 330 + slower_us, SINK, 2 * i, FILTER_OUT)
        if twice:
            filtering += publish(t + 150, FILTER_OUT, 2 * i + 1)
            sink += wait(t + 335, t + 340) + take(t + 350, SINK, 2 * i + 1, FILTER_OUT)
    endpoints = {
        endpoint_id(slot, INCARNATION): Endpoint(
            is_publisher, "topic", topic, "std_msgs/msg/String", node, 1
        )
        for slot, (is_publisher, topic, node) in NAMES.items()
    }
    return Trace(
        "test",
        (
            process(1, camera, lost=3),
            process(2, filtering),
            process(3, sink),
            process(2, told, is_receive_thread=True),
        ),
        endpoints,
        4,
    )


def starting(trace: Trace, until_us: int) -> Trace:
    """Let the sink join when the trace begins, and wait for no work until a time."""
    camera, filtering, sink, told = trace.processes
    (thread,) = sink.threads
    events = thread.events
    is_wait = np.isin(events["kind"], (Kind.WAIT_BEGIN, Kind.WAIT_END))
    later = events[~is_wait | (events["time_ns"] >= until_us * US)]
    joined = np.concatenate([np.array([event(1, Kind.JOIN, NO_ENDPOINT)], EVENT), later])
    sink = replace(sink, threads=(replace(thread, events=joined),))
    return replace(trace, processes=(camera, filtering, sink, told))


def evaluated(trace: Trace) -> list[ChainLatency]:
    messages = Messages(trace)
    return latencies(messages, messages.chains)
