# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A skeleton's nodes in processes of their own."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from rmw_manycore_py.bench.idle import wait_until_quiet
from rmw_manycore_py.bench.scale.skeleton import Skeleton
from rmw_manycore_py.bench.session import TIMEOUT_S, Process, Session
from rmw_manycore_py.errors import ManycoreError

SETTLE_S = 30.0
QUIET_S = 2.0  # Fast DDS never is


@dataclass(frozen=True)
class Exchanged:
    """Messages of a run.

    :param due: to subscriptions, by what was published.
    :param ages_ns: of those that arrived.
    """

    published: int
    due: int
    ages_ns: Sequence[int]

    @property
    def lost(self) -> int:
        """Return the messages that did not arrive."""
        return self.due - len(self.ages_ns)


class SkeletonRun:
    """Nodes that have matched all their topics, and publish when told to.

    Nodes that hang are killed: the session's time is for their start, and TIMEOUT_S for what is
    done with them before they publish, and for all after it.
    """

    def __init__(self, session: Session, skeleton: Skeleton) -> None:
        """Start the nodes, and return once all are ready.

        :raises ManycoreError: if they are not within the session's time.
        """
        self._session = session
        self._nodes = [
            session.native("skeleton_node", party, **arguments)
            for party, arguments in enumerate(skeleton.arguments())
        ]
        ready = sum(_is_ready(node) for node in self._nodes)
        if ready < len(self._nodes):
            raise ManycoreError(f"{ready} of {len(self._nodes)} nodes are ready in time")
        self._give(TIMEOUT_S)

    @property
    def pids(self) -> list[int]:
        """Return the processes of the nodes."""
        return [node.pid for node in self._nodes]

    @property
    def all_pids(self) -> list[int]:
        """Return the processes of nodes and receive threads."""
        return [*self.pids, *self._session.receive_thread_pids()]

    def publish(self, duration_s: float) -> None:
        """Publish at the rates of the skeleton."""
        self._give(duration_s + TIMEOUT_S)
        self._send("publish")
        time.sleep(duration_s)
        self._send("stop")

    def settle(self, timeout_s: float = SETTLE_S) -> None:
        """Return when all that was published has arrived, or nothing more will."""
        deadline = time.monotonic() + timeout_s
        while not self._have_all() and time.monotonic() < deadline:
            if wait_until_quiet(self.pids, timeout_s=QUIET_S):
                return

    def finish(self) -> Exchanged:
        """End the nodes; return what they exchanged."""
        for node in self._nodes:
            node.release()
        found = [node.finish() for node in self._nodes]
        return Exchanged(
            sum(one["published"] for one in found),
            sum(one["due"] for one in found),
            [age_ns for one in found for age_ns in one["samples_ns"]],
        )

    @contextmanager
    def named_if_dead(self) -> Iterator[None]:
        """Turn what the end of a process leads to in the block into ManycoreError."""
        try:
            yield
        except OSError as error:  # of its files in /proc
            for node in self._nodes:
                node.raise_if_failed()
            raise ManycoreError(f"a process has ended: {error}") from error

    def _give(self, timeout_s: float) -> None:
        for node in self._nodes:
            node.give(timeout_s)

    def _have_all(self) -> bool:
        self._send("count")
        counts = [node.next_line().split() for node in self._nodes]
        return sum(int(due) for due, _ in counts) == sum(int(received) for _, received in counts)

    def _send(self, line: str) -> None:
        for node in self._nodes:
            node.send_line(line)


def _is_ready(node: Process) -> bool:
    with suppress(ManycoreError):  # killed after its time
        node.wait_until_ready()
        return True
    return False
