# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The latency of a topic equals the communication time of `manycore trace latency`."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rmw_manycore_py.platform.monitor.latency import topic_latencies
from rmw_manycore_py.trace.events import Endpoint, Trace, endpoint_id
from support.samples.traces import (
    CAMERA,
    INCARNATION,
    NAMES,
    evaluated,
    example,
    process,
    publish,
    take,
)

pytestmark = pytest.mark.unit

READER = 9


def trace_of(takes_us: dict[int, int], camera: int = CAMERA) -> Trace:
    """Return a trace of numbered messages, each taken so long after its publish began."""
    published, taken = [], []
    for row, (number, take_us) in enumerate(takes_us.items()):
        published += publish(1000 * (row + 1), camera, number)
        taken += take(1000 * (row + 1) + take_us - 3, READER, number, camera)
    endpoint = Endpoint(True, "topic", "/image", "T", "/camera", 1)
    names = {endpoint_id(camera, INCARNATION): endpoint}
    return Trace("test", (process(1, published), process(2, taken)), names, 0)


def test_it_is_that_of_the_chain() -> None:
    trace = example(slower_us=7)
    found = topic_latencies(trace)
    (chain,) = evaluated(trace)
    parts = {part.name: part for part in chain.parts}
    assert found.keys() == {topic for _, topic, _ in NAMES.values()}
    for topic, latency in found.items():
        part = parts[f"communication {topic}"]
        assert latency.count == len(part.samples_us) == 8
        assert (latency.p50_us, latency.p99_us) == pytest.approx(
            (part.quantile(0.5), part.quantile(0.99))
        )


def test_quantiles_are_those_of_the_samples() -> None:
    found = topic_latencies(trace_of({1: 100, 2: 200, 3: 300, 4: 900}))["/image"]
    assert (found.count, found.p50_us) == (4, pytest.approx(250))
    assert 850 < found.p99_us < 900


def test_only_late_arrivals_count() -> None:
    trace = trace_of({1: 100, 2: 200, 3: 300, 4: 900})
    assert topic_latencies(trace, since_ns=4_000_000)["/image"].count == 1
    assert topic_latencies(trace, since_ns=10**12) == {}


def test_records_are_distinguished_by_all_of_their_numbers() -> None:
    """Numbers that differ in their high half only, and slots in their high half only."""
    found = topic_latencies(trace_of({7: 100, 1 << 32 | 7: 200}))["/image"]
    assert (found.count, found.p50_us) == (2, pytest.approx(150))
    near, far = trace_of({7: 100}), trace_of({7: 500}, camera=1 << 16 | CAMERA)
    far_name = {end: replace(name, topic="/far") for end, name in far.endpoints.items()}
    both = replace(
        near,
        processes=(*near.processes, *far.processes),
        endpoints={**near.endpoints, **far_name},
    )
    found_both = topic_latencies(both)
    assert {topic: round(one.p50_us) for topic, one in found_both.items()} == {
        "/image": 100,
        "/far": 500,
    }


def test_a_trace_of_nothing_has_none() -> None:
    assert topic_latencies(Trace("test", (), {}, 0)) == {}
    assert topic_latencies(trace_of({})) == {}


def test_topics_without_a_name_are_left_out() -> None:
    assert topic_latencies(replace(trace_of({1: 100}), endpoints={})) == {}
