# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The latency of a topic is what `manycore trace latency` calls its communication."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.look.latency import topic_latencies
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import EVENT, Endpoint, Kind, Process, Thread, Trace, endpoint_id
from rmw_manycore_py.trace.latency import latencies

pytestmark = pytest.mark.unit

SLOT, INCARNATION, READER = 3, 5, 4


def thread(*events: tuple[int, int, int, int, int, int]) -> Thread:
    return Thread(1, "main", np.array(list(events), dtype=EVENT), 0)


def process(pid: int, one: Thread) -> Process:
    return Process(pid, 1, 1, 0, "p", False, True, (one,), 0)


def trace_of(takes_us: list[int]) -> Trace:
    published, taken = [], []
    for number, take_us in enumerate(takes_us):
        begin_ns = 1_000_000 * (number + 1)
        for kind, after_ns in ((Kind.PUBLISH_BEGIN, 0), (Kind.WRITE, 10), (Kind.PUBLISH_END, 20)):
            known = 0 if kind == Kind.PUBLISH_BEGIN else number  # as it has none yet
            published.append((begin_ns + after_ns, known, 0, SLOT, INCARNATION, kind))
        publisher = endpoint_id(SLOT, INCARNATION)
        end_ns = begin_ns + 1000 * take_us
        taken.append((end_ns - 1, number, publisher, READER, 1, Kind.CLAIM))
        taken.append((end_ns, number, publisher, READER, 1, Kind.RELEASE))
    ends = {
        endpoint_id(SLOT, INCARNATION): Endpoint(True, "topic", "/t", "T", "/talker", 1),
        endpoint_id(READER, 1): Endpoint(False, "topic", "/t", "T", "/listener", 1),
    }
    return Trace("p", (process(1, thread(*published)), process(2, thread(*taken))), ends, 0)


def test_it_is_that_of_the_chain() -> None:
    trace = trace_of([100, 200, 300, 900])
    found = topic_latencies(trace)["/t"]
    messages = Messages(trace)
    (chain,) = latencies(messages, messages.chains)
    part = chain.parts[0]
    assert part.name == "communication /t"
    assert (found.p50_us, found.p99_us, found.count) == pytest.approx(
        (part.quantile(0.5), part.quantile(0.99), 4)
    )


def test_only_late_arrivals_count() -> None:
    found = topic_latencies(trace_of([100, 200, 300, 900]), since_ns=4_000_000)
    assert found["/t"].count == 1
    assert topic_latencies(trace_of([100]), since_ns=10**12) == {}
