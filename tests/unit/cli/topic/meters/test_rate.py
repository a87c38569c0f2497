# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The statistics of `topic hz`."""

import pytest

from rmw_manycore_py.cli.topic.meters.rate import RateMeter

pytestmark = pytest.mark.unit


def meter_of(*times_s: float, window: int = 100) -> RateMeter:
    meter = RateMeter(window)
    for time_s in times_s:
        meter.arrived(time_s)
    return meter


def test_one_message_has_no_rate() -> None:
    assert meter_of(1.0).rate() is None


def test_statistics_and_their_format() -> None:
    text = str(meter_of(0.0, 0.5, 1.0, 2.0).rate())
    assert text == ("average rate: 1.500\n\tmin: 0.500s max: 1.000s std dev: 0.23570s window: 3")


def test_the_window_forgets() -> None:
    rate = meter_of(0.0, 100.0, 100.5, 101.0, window=2).rate()
    assert rate is not None
    assert rate.rate_hz == pytest.approx(2.0)
    assert rate.window == 2
