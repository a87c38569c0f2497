# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Keys that control a player."""

from __future__ import annotations

import pytest

from rmw_manycore_py.cli.topic.play_keys import press
from rmw_manycore_py.recording.play.position import Position

pytestmark = pytest.mark.unit


def test_space_pauses_and_goes_on() -> None:
    position = Position(1.0, paused=False)
    press(position, " ")
    assert position.is_paused
    press(position, "x \x1b[Z")
    assert not position.is_paused


@pytest.mark.parametrize(
    ("typed", "rate"), [("\x1b[A", 1.1), ("\x1bOA\x1b[A", 1.21), ("\x1b[B", 1 / 1.1)]
)
def test_arrows_change_the_rate(typed: str, rate: float) -> None:
    position = Position(1.0, paused=False)
    press(position, typed)
    assert position.rate == pytest.approx(rate)


def test_right_plays_a_message() -> None:
    position = Position(1.0, paused=True)
    press(position, "\x1b[C")
    assert position.wait_until(5) == 0
