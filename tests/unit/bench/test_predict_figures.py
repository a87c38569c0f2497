# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Figures of a measured run, with which predictions are compared."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rmw_manycore_py.bench.predict.figures import measured_figures
from rmw_manycore_py.trace.events import Kind
from support.samples.traces import example

pytestmark = pytest.mark.unit

STARTS_MS = 55  # between two of the messages, which come every 10 ms


def test_messages_count_from_when_all_nodes_wait_for_work() -> None:
    trace = example(rounds=40)
    camera, filtering, sink, told = trace.processes
    (thread,) = sink.threads
    is_wait = (thread.events["kind"] == Kind.WAIT_BEGIN) | (thread.events["kind"] == Kind.WAIT_END)
    is_early = thread.events["time_ns"] < STARTS_MS * 1_000_000
    late = replace(thread, events=thread.events[~(is_wait & is_early)])
    starting = replace(trace, processes=(camera, filtering, replace(sink, threads=(late,)), told))
    counts = [
        [one.count for one in measured_figures(each).chains.values()] for each in (trace, starting)
    ]
    assert counts == [[40], [35]]
