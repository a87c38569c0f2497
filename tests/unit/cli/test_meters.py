# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bandwidth, delay and load, as `manycore` computes and writes them."""

from __future__ import annotations

import pytest

from rmw_manycore_py.cli.bandwidth import BandwidthMeter
from rmw_manycore_py.cli.delay import DelayMeter
from rmw_manycore_py.cli.load import Sample, process_loads, topic_loads

pytestmark = pytest.mark.unit


def test_bandwidth_is_of_the_window() -> None:
    meter = BandwidthMeter(window=3)
    assert meter.bandwidth(0.0) is None
    for number in range(4):
        meter.arrived(float(number), 1000 * (number + 1))
    found = meter.bandwidth(4.0)
    assert found is not None
    assert (found.messages, found.shortest, found.longest) == (3, 2000, 4000)
    assert found.bytes_per_s == 3000.0
    assert str(found) == (
        "3.00 KB/s from 3 messages\n\tMessage size mean: 3.00 KB min: 2.00 KB max: 4.00 KB"
    )


def test_small_bandwidths_are_in_bytes_and_large_ones_in_megabytes() -> None:
    meter = BandwidthMeter(window=10)
    meter.arrived(0.0, 20)
    meter.arrived(1.0, 20)
    assert str(meter.bandwidth(2.0)).startswith("20 B/s from 2 messages")
    meter.arrived(1.5, 4_000_000)
    assert str(meter.bandwidth(2.0)).startswith("2.00 MB/s from 3 messages")


def test_delay_is_of_the_window() -> None:
    meter = DelayMeter(window=2)
    assert meter.delay() is None
    for delay_s in (9.0, 0.1, 0.3):
        meter.arrived(delay_s)
    assert str(meter.delay()) == (
        "average delay: 0.200\n\tmin: 0.100s max: 0.300s std dev: 0.10000s window: 2"
    )


def endpoint(gid: str, kind: str, **counters: int) -> dict[str, object]:
    return {"gid": gid, "kind": kind, "role": "topic", "topic": "/t", "counters": counters}


def test_loads_are_differences() -> None:
    process = {"pid": 7, "label": "talker", "cluster": 1, "core": 2, "host_cpu": 0}
    before = Sample(
        10.0,
        [process],
        [endpoint("a", "publisher", messages=5, bytes=50)],
        {7: 1.0, 8: 0.5},
    )
    after = Sample(
        12.0,
        [process],
        [
            endpoint("a", "publisher", messages=9, bytes=90),
            endpoint("b", "publisher", messages=2, bytes=20),
            endpoint("c", "subscription", messages=3, bytes=30, lost=4),
        ],
        {7: 1.5, 8: 0.5, 9: 3.0},
    )
    loads = {row["pid"]: row for row in process_loads(before, after)}
    assert [row["cpu_percent"] for row in loads.values()] == [25.0, 0.0, 0.0]
    assert (loads[7]["label"], loads[8]["label"]) == ("talker", "(receive thread)")
    (topic,) = topic_loads(before, after)
    assert topic == {"topic": "/t", "messages_per_s": 3.0, "bytes_per_s": 30.0, "lost": 4}
