# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that stay while others die, and check that they notice nothing."""

from __future__ import annotations

import re

from support import wait_until
from support.nodes.load import check_steadily, publish_steadily
from support.processes.commands import peer_command
from support.processes.program import Program
from support.processes.running_time import RunningTime

RECOVERY_S = 1.0  # the promise: the others go on, and what a dead process held is reclaimed


class Load:
    """A publisher and two subscriptions that must not notice anything, in two clusters."""

    def __init__(self, start, running_time: RunningTime) -> None:
        self._running_time = running_time
        self.publisher = start(peer_command(publish_steadily, 50.0))
        self.checkers: list[Program] = []
        writer = None
        for cluster in (1, 2):
            # The publisher waits for the first subscription before it prints its pid.
            writer = writer or self.publisher.pid
            checker = start(peer_command(check_steadily, writer), cluster)
            checker.wait_for("checking")
            self.checkers.append(checker)
        self.publisher.wait_for(f"publishing as {writer}")

    def counts(self) -> list[tuple[int, int]]:
        """Return how many messages each subscription has received, and how many it misses."""
        for checker in self.checkers:
            checker.say("how many?")
        matches = [checker.wait_for(r"heard (\d+), missing (\d+)") for checker in self.checkers]
        return [(int(match.group(1)), int(match.group(2))) for match in matches]

    def wait_until_it_goes_on(self) -> None:
        """Wait for ten more messages at each subscription."""
        before = self.counts()

        def all_have_more() -> bool:
            assert self.publisher.is_running(), self.publisher
            pairs = zip(self.counts(), before, strict=True)
            return all(now[0] >= then[0] + 10 for now, then in pairs)

        wait_until(all_have_more, "every subscription receives messages again")

    def assert_unharmed(self) -> None:
        """Check that nothing is lost, torn or out of order, and that no gap is too long."""
        self.assert_in_order()
        assert self.missing() == 0
        for program in self.checkers:
            for gap in re.finditer(r"heard nothing from (\d+) to (\d+)", program.output):
                counted_s = self._running_time.between_s(int(gap[1]), int(gap[2]))
                assert counted_s <= RECOVERY_S, program

    def assert_it_goes_on_unharmed(self) -> None:
        self.wait_until_it_goes_on()
        self.assert_unharmed()

    def assert_in_order(self) -> None:
        for program in (self.publisher, *self.checkers):
            assert program.is_running(), program
            assert "torn" not in program.output, program
            assert "wrong order" not in program.output, program

    def missing(self) -> int:
        """Return how many messages did not reach a subscription."""
        return sum(missing for _, missing in self.counts())
