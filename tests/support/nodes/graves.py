# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Processes that were killed, and how long their platform takes to notice."""

from __future__ import annotations

import time

from support import IS_MANYCORE
from support.nodes.steady_load import RECOVERY_S, Load
from support.processes.inspection import kill
from support.processes.program import Program
from support.processes.running_time import RunningTime


class Graves:
    """Kills processes, and measures how long the platform still lists them as members."""

    def __init__(self, platform: str, running_time: RunningTime) -> None:
        self._platform = platform
        self._running_time = running_time
        self._killed_ns: dict[int, int] = {}

    def kill(self, pid: int) -> None:
        kill(pid)
        self.note(pid)

    def note(self, pid: int) -> None:
        """Record that a process has ended just now."""
        self._killed_ns[pid] = time.monotonic_ns()

    def assert_reclaimed(self) -> None:
        """Check that no process in the registry has been dead for longer than RECOVERY_S."""
        for pid in self._members():
            assert self._running_time.since_s(self._killed_ns[pid]) <= RECOVERY_S, (
                f"the platform still takes process {pid} for a member"
            )

    def assert_all_reclaimed(self) -> None:
        self._running_time.wait_within(RECOVERY_S, lambda: not self._members(), "none is left")

    def assert_survived_by(self, load: Load, nursery: Program) -> None:
        """Check that all is reclaimed, and that neither the load nor a victim was harmed."""
        self.assert_all_reclaimed()
        load.assert_it_goes_on_unharmed()
        assert "torn" not in nursery.output, nursery

    def _members(self) -> list[int]:
        """Return the killed processes that still have a slot in the registry."""
        if not IS_MANYCORE:
            return []
        from rmw_manycore_py.native._transport import Platform

        with Platform(self._platform) as platform:
            processes = platform.processes()
        dead = [process.pid for process in processes if not process.alive]
        return [pid for pid in dead if pid in self._killed_ns]
