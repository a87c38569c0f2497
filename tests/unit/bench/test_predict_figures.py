# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Figures of a measured run, with which predictions are compared."""

from __future__ import annotations

import pytest

from rmw_manycore_py.bench.predict.figures import measured_figures
from support.samples.traces import example, starting

pytestmark = pytest.mark.unit

STARTS_US = (5_000, 55_000)  # before all messages, and between two: they come every 10 ms


def test_messages_count_from_when_all_nodes_wait_for_work() -> None:
    trace = example(rounds=40)
    counts = [
        [one.count for one in measured_figures(starting(trace, until_us)).chains.values()]
        for until_us in STARTS_US
    ]
    assert counts == [[40], [35]]
