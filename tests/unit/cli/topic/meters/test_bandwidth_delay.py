# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bandwidth and delay, as `manycore topic` computes and prints them."""

from __future__ import annotations

import pytest

from rmw_manycore_py.cli.topic.meters.bandwidth import BandwidthMeter
from rmw_manycore_py.cli.topic.meters.delay import DelayMeter

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
