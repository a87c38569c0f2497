# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Spinning that interrupts end between two calls of rclpy."""

from __future__ import annotations

import signal

import pytest

from rmw_manycore_py.process.spinning import spin_once

pytestmark = pytest.mark.rmw


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_waits_for_the_end_of_a_callback(node, number) -> None:
    done = []

    def work() -> None:
        signal.raise_signal(number)
        done.append(number)
        timer.cancel()

    def spin() -> None:
        while True:
            spin_once(node, signals=(signal.SIGINT, signal.SIGTERM))

    timer = node.create_timer(0.01, work)
    before = signal.signal(number, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            spin()
    finally:
        signal.signal(number, before)
    assert done == [number]
