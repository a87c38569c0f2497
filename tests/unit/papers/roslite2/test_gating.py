# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The gate forwards one source's commands, and none while a heartbeat is late."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.papers.roslite2.laws.gating import Gate, GateOptions, Passage, Source

pytestmark = pytest.mark.unit


def engaged(**options: object) -> Gate:
    """Return a gate whose external heartbeat arrived at 0 s."""
    gate = Gate(GateOptions(**options), is_engaged=True)
    gate.external_heartbeat(0.0)
    return gate


def test_nothing_passes_before_the_first_heartbeat():
    gate = Gate(GateOptions(), is_engaged=True)
    assert gate.missing() == ("external heartbeat",)
    assert not gate.tick(100.0)
    assert gate.passage(Source.AUTO) is Passage.BLOCKED
    gate.external_heartbeat(100.0)
    assert gate.passage(Source.AUTO) is Passage.PASSED


def test_a_vehicle_that_is_not_engaged_is_held():
    gate = engaged()
    gate.is_engaged = False
    assert gate.passage(Source.AUTO) is Passage.HELD


def test_one_source_passes():
    gate = engaged()
    assert gate.passage(Source.EXTERNAL) is Passage.BLOCKED
    gate.source = Source.EXTERNAL
    assert gate.passage(Source.EXTERNAL) is Passage.PASSED
    assert gate.passage(Source.AUTO) is Passage.BLOCKED


@pytest.mark.parametrize("watches", [True, False])
def test_the_emergency_handler_takes_over_where_it_is_heeded(watches):
    gate = engaged(watches_system=watches)
    gate.system_state(0.0, is_emergency=True)
    assert gate.wanted_source() is (Source.EMERGENCY if watches else Source.AUTO)
    assert (gate.passage(Source.EMERGENCY) is Passage.PASSED) == watches


def test_a_late_state_of_the_emergency_handler_stops_until_it_comes_again():
    gate = engaged(watches_system=True, watches_external=False)
    gate.system_state(0.0, is_emergency=False)
    assert gate.tick(0.6)
    assert gate.passage(Source.AUTO) is Passage.BLOCKED
    gate.system_state(0.7, is_emergency=False)
    assert not gate.tick(0.7)
    assert gate.passage(Source.AUTO) is Passage.PASSED


def test_a_stop_lasts_until_it_is_cleared():
    gate = engaged()
    assert not gate.clear()
    gate.stop()
    assert gate.tick(0.1)
    assert gate.clear()
    assert not gate.tick(0.1)


def test_a_late_heartbeat_stops_and_cannot_be_cleared_before_it_is_back():
    gate = engaged()
    assert gate.tick(0.6)
    assert not gate.clear()
    gate.external_heartbeat(0.7)
    assert gate.tick(0.7)  # still stopped
    assert gate.clear()
    assert not gate.tick(0.8)


def test_no_timeout():
    assert not engaged(external_timeout_s=0.0).tick(1e9)


def test_a_thousand_random_histories():
    """The emergency command is due after a gap longer than 0.5 s, until it is cleared."""
    generator = np.random.default_rng(4)
    for _ in range(1000):
        gate, now, beat, stopped = engaged(), 0.0, 0.0, False
        for act in generator.choice(
            ["beat", "tick", "clear", "stop"], 20, p=[0.4, 0.4, 0.15, 0.05]
        ):
            now += float(generator.exponential(0.15))
            if act == "beat":
                gate.external_heartbeat(now)
                beat = now
            elif act == "stop":
                gate.stop()
                stopped = True
            elif act == "clear":
                late = gate.is_external_late
                stopped = stopped and not (gate.clear() and not late)
            else:
                stopped |= now - beat > 0.5
                assert gate.tick(now) == stopped
            passes = gate.passage(Source.AUTO) is Passage.PASSED
            assert passes == (not stopped)
