# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The position of a player, on a clock that the test sets."""

from __future__ import annotations

import threading

import pytest

from rmw_manycore_py.recording.play.position import Position

pytestmark = pytest.mark.unit

S = 1_000_000_000


class Watch:
    def __init__(self) -> None:
        self.now_ns = 5 * S
        self.asked = threading.Event()

    def __call__(self) -> int:
        self.asked.set()
        return self.now_ns


class Waiting:
    """A thread that waits for a position.

    The thread reads the clock under the position's lock and releases the lock when it sleeps: a
    change of the position after that read finds it asleep.
    """

    def __init__(self, position: Position, watch: Watch, at_ns: int) -> None:
        self.result: int | None = -1
        self._thread = threading.Thread(target=self._wait, args=(position, at_ns))
        watch.asked.clear()
        self._thread.start()
        assert watch.asked.wait(30)

    def _wait(self, position: Position, at_ns: int) -> None:
        self.result = position.wait_until(at_ns)

    def ended(self) -> int | None:
        self._thread.join(30)
        assert not self._thread.is_alive()
        return self.result


@pytest.fixture
def watch() -> Watch:
    return Watch()


def test_it_runs_at_its_rate(watch: Watch) -> None:
    position = Position(2.0, paused=False, now_ns=watch)
    position.jump(100 * S)
    watch.now_ns += 3 * S
    assert position.at_ns() == 106 * S
    assert position.wait_until(104 * S) == 1 * S  # one second late in real time


def test_it_stands_while_paused(watch: Watch) -> None:
    position = Position(1.0, paused=True, now_ns=watch)
    watch.now_ns += S
    assert position.at_ns() == 0
    position.toggle_pause()
    watch.now_ns += S
    position.toggle_pause()
    watch.now_ns += S
    assert (position.at_ns(), position.is_paused) == (S, True)


def test_the_rate_changes_from_here_on(watch: Watch) -> None:
    position = Position(1.0, paused=False, now_ns=watch)
    watch.now_ns += 10 * S
    position.faster()
    assert position.at_ns() == 10 * S
    assert position.rate == pytest.approx(1.1)
    position.slower()
    assert position.rate == pytest.approx(1.0)


def test_a_step_goes_to_the_next_message(watch: Watch) -> None:
    position = Position(1.0, paused=True, now_ns=watch)
    position.step()
    assert position.wait_until(7 * S) == 0
    assert position.at_ns() == 7 * S


def test_a_step_counts_only_while_paused(watch: Watch) -> None:
    position = Position(1.0, paused=False, now_ns=watch)
    position.step()
    position.toggle_pause()
    waiting = Waiting(position, watch, S)
    position.stop()
    assert waiting.ended() is None
    assert position.at_ns() == 0


def test_a_step_wakes_the_wait(watch: Watch) -> None:
    position = Position(1.0, paused=True, now_ns=watch)
    waiting = Waiting(position, watch, S)
    position.step()
    assert waiting.ended() == 0
    assert position.at_ns() == S


def test_stopping_ends_the_wait(watch: Watch) -> None:
    position = Position(1.0, paused=True, now_ns=watch)
    waiting = Waiting(position, watch, S)
    position.stop()
    assert waiting.ended() is None
    assert position.wait_until(S) is None


def test_a_time_that_rolled_over_is_waited_for(watch: Watch) -> None:
    position = Position(0.01, paused=False, now_ns=watch)
    waiting = Waiting(position, watch, 2**64 - 1)
    position.stop()
    assert waiting.ended() is None
