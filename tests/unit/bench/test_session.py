# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A process of a bench ends in time, and its end is reported."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from rmw_manycore_py.bench.session import Process, usable_cpus
from rmw_manycore_py.errors import ManycoreError
from support import TIMEOUT_S, wait_until

pytestmark = pytest.mark.unit

ECHO = ("cat",)
DEAF = ("sh", "-c", "exec <&-; echo ready; sleep 0.2")


@contextmanager
def running(*command: str) -> Iterator[Process]:
    process = Process("peer", command, dict(os.environ), usable_cpus(), timeout_s=TIMEOUT_S)
    try:
        yield process
    finally:
        process.close()


def test_a_process_is_killed_after_the_time_it_was_given_last() -> None:
    with running(*ECHO) as process:
        process.give(0)
        with pytest.raises(ManycoreError, match=r"peer: .* exit status -9"):
            process.next_line()


def test_no_timer_outlives_its_process() -> None:
    before = set(threading.enumerate())
    with running(*ECHO) as process:
        process.give(10 * TIMEOUT_S)
        process.give(20 * TIMEOUT_S)
    wait_until(lambda: set(threading.enumerate()) <= before, "the timers have ended", TIMEOUT_S / 2)


def test_a_line_to_or_from_a_process_that_has_ended_is_an_error() -> None:
    with running(*ECHO) as process:
        process.send_line("a line")
        assert process.next_line() == "a line\n"
        os.kill(process.pid, signal.SIGKILL)
        for talk in (process.next_line, lambda: process.send_line("more")):
            with pytest.raises(ManycoreError, match=r"peer: .* exit status -9"):
                talk()


def test_a_line_that_nobody_reads_is_an_error() -> None:
    with running(*DEAF) as process:
        process.wait_until_ready()
        with pytest.raises(ManycoreError, match=r"peer: .* has ended early"):
            process.send_line("unread")
