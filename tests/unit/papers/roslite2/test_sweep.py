# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which callback a slow drive waits for."""

from __future__ import annotations

import pytest

from rmw_manycore_py.papers.roslite2.sweep import blamed_in
from support.samples.traces import example

pytestmark = pytest.mark.unit


def test_the_busiest_callback_where_messages_wait_longest_is_to_blame() -> None:
    # The filter has a message 33 us after its publication, the sink 200 us.
    blamed = blamed_in(example(rounds=20))
    assert (blamed.node, blamed.topic, blamed.trigger) == ("/sink", "/small", "/small")
    assert blamed.wait_ms == pytest.approx(0.2)
    # From its take until it waits again, 9,567 of 10,000 us; the last execution has no end.
    assert blamed.share == pytest.approx(0.9567, rel=0.02)
