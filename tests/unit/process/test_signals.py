# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Deferred signals."""

from __future__ import annotations

import signal

import pytest

from rmw_manycore_py.cli.common.tool_node import result_of
from rmw_manycore_py.process.signals import interrupts_held

pytestmark = pytest.mark.unit


def test_an_interrupt_is_raised_at_the_end_of_the_block():
    done = []

    def interrupted() -> None:
        with interrupts_held():
            signal.raise_signal(signal.SIGINT)
            done.append(True)

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert done
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_outlives_an_error_of_the_block():
    def interrupted() -> None:
        with interrupts_held():
            signal.raise_signal(signal.SIGINT)
            raise ValueError

    with pytest.raises(KeyboardInterrupt):
        interrupted()


def test_a_verb_is_interrupted_when_it_has_asked():
    done = []

    def ask() -> None:
        signal.raise_signal(signal.SIGINT)
        done.append(True)

    with pytest.raises(KeyboardInterrupt):
        result_of(None, ask, "/server")
    assert done


def test_each_signal_goes_to_the_handler_that_it_had():
    heard = []
    before = signal.signal(signal.SIGTERM, lambda number, _frame: heard.append(number))
    try:
        with interrupts_held((signal.SIGINT, signal.SIGTERM)):
            signal.raise_signal(signal.SIGTERM)
            assert not heard
    finally:
        signal.signal(signal.SIGTERM, before)
    assert heard == [signal.SIGTERM]
