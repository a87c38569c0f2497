# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS that a recorder requests from publishers."""

from __future__ import annotations

import pytest

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.play.program import offer_of
from rmw_manycore_py.recording.record.topic import request_for

pytestmark = pytest.mark.unit

LATCHED = Qos(durability="transient_local", depth=3)
SENSOR = Qos(reliability="best_effort", depth=5)


def test_it_asks_for_no_more_than_all_offer() -> None:
    assert request_for([LATCHED], 2) == Qos(durability="transient_local", depth=3)
    assert request_for([LATCHED, SENSOR], 2) == Qos(reliability="best_effort", depth=8)
    assert request_for([SENSOR], 100) == Qos(reliability="best_effort", depth=100)


def test_a_player_offers_what_any_of_them_did() -> None:
    assert offer_of([LATCHED, SENSOR]) == Qos(durability="transient_local", depth=8)
    assert offer_of([SENSOR]) == Qos(reliability="best_effort", depth=10)
    assert offer_of([]) == Qos()
