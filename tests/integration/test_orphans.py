# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Processes that a killed bench or run has started end with it."""

from __future__ import annotations

import signal
from contextlib import suppress
from pathlib import Path

import pytest

from support import IS_MANYCORE, MAPFILES, wait_until
from support.processes.commands import manycore_command
from support.processes.platforms import unique_platform

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

ENDLESS = ("--rounds", "100000", "--only")  # it does not end before all are seen
MARK = "MANYCORE_TEST_MARK"  # inherited by all descendants, receive threads included


def marked(mark: str) -> list[int]:
    """Return the processes that were started with the mark in their environment."""
    words = f"{MARK}={mark}".encode()
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # of another user, or ended
            if words in (process / "environ").read_bytes().split(b"\0"):
                found.append(int(process.name))
    return found


@pytest.mark.parametrize(
    ("words", "processes"),
    [
        (("bench", "rmw", "round-trip", *ENDLESS, "(block)"), 3),
        (("bench", "rmw", "round-trip", *ENDLESS, "futex"), 3),
        (("bench", "rmw", "round-trip", *ENDLESS, "pipe"), 4),
        (("bench", "rclpy", *ENDLESS, "Fast DDS"), 3),
        (("bench", "idle", "--nodes", "6", *ENDLESS, "manycore"), 7),
        (("bench", "bridge", *ENDLESS, "bridged"), 5),
        (("run", MAPFILES / "talker_listener.yaml"), 7),
    ],
    ids=lambda value: "-".join(map(str, value[:2])) if isinstance(value, tuple) else None,
)
def test_nothing_outlives_a_killed_parent(start, words, processes) -> None:
    mark = unique_platform()
    parent = start(manycore_command(*words), **{MARK: mark})
    wait_until(lambda: len(marked(mark)) >= processes or not parent.is_running(), "all are started")
    assert parent.is_running(), parent
    parent.signal(signal.SIGKILL)
    wait_until(lambda: not marked(mark), "all have ended")
