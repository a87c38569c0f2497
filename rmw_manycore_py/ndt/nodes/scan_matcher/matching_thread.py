# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Thread that owns the matcher, so that the executor handles guesses during matching."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from rmw_manycore_py.ndt.nodes.scan_matcher.scan_inbox import ScanInbox, WaitingScan
from rmw_manycore_py.process.steady import steady_s
from rmw_manycore_py.process.virtual_time import lives_in_virtual_time

Job = Callable[[], None]
# Incremental work: yields False if it has to wait for `wake`.
Steps = Iterator[bool]


class MatchingError(Exception):
    """What ended the thread; no RuntimeError, which after a shutdown would be taken for rcl's."""


class MatchingThread:
    """Matches scans and runs jobs, one at a time; sleeps when idle.

    Long work is done in steps: one after each scan, and continuously while no scan or job waits.

    :param inbox: holds waiting scans.
    :param match: called with each scan taken.
    :param skip: called with each scan overtaken by a newer one.
    :param is_over: returns whether the node's context is shut down: nothing can be published then,
        and errors caused by that end the thread silently.
    :param failed: called when one of these raised; close() then raises MatchingError.
    """

    def __init__(
        self,
        inbox: ScanInbox,
        match: Callable[[Any], None],
        skip: Callable[[Any], None],
        is_over: Callable[[], bool],
        failed: Callable[[], None],
    ) -> None:
        self._inbox = inbox
        self._match = match
        self._skip = skip
        self._is_over = is_over
        self._failed = failed
        self._changed = threading.Condition()
        self._jobs: deque[Job] = deque()
        self._steps: deque[Steps] = deque()
        self._may_step = True  # woken since the last step had to wait
        self._steps_turn = False  # prevents a stream of scans from starving steps
        self._closing = False
        self._failure: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="matching")
        self._thread.start()

    def put_scan(self, message: Any, stamp_s: float) -> None:
        """Queue a scan; it is skipped if a newer one is ready first. Thread-safe."""
        with self._changed:
            self._inbox.put(message, stamp_s, steady_s())
            self._changed.notify()

    def wake(self) -> None:
        """Wake the thread: a guess or map that is waited for may be available. Thread-safe."""
        with self._changed:
            self._may_step = True
            self._changed.notify()

    def post(self, job: Job) -> None:
        """Run a job before the next scan. Thread-safe."""
        with self._changed:
            self._jobs.append(job)
            self._changed.notify()

    def post_steps(self, steps: Steps) -> None:
        """Run steps one by one, between scans and jobs; they must not raise. Thread-safe."""
        with self._changed:
            self._steps.append(steps)
            self._may_step = True
            self._changed.notify()

    def close(self) -> None:
        """Stop the thread after its current work.

        :raises MatchingError: from the error that ended it earlier.
        """
        with self._changed:
            self._closing = True
            self._changed.notify()
        self._thread.join()
        if self._failure is not None:
            raise MatchingError(str(self._failure)) from self._failure

    def _run(self) -> None:
        try:
            while True:
                skipped, work = self._next()
                for scan in skipped:
                    self._skip(scan.message)
                if work is None:
                    return
                work()
        except BaseException as error:
            if not self._is_over():
                self._failure = error
                self._failed()

    def _next(self) -> tuple[list[WaitingScan], Job | None]:
        """Block until there is work; return skipped scans and the work, or None at the end."""
        with self._changed:
            while not self._closing:
                if self._jobs:
                    return self._inbox.take_skipped(), self._jobs.popleft()
                can_step = bool(self._steps) and self._may_step
                if can_step and self._steps_turn:
                    return [], self._step
                now_s = steady_s()
                scan = self._inbox.take(now_s)
                if scan is not None:
                    self._steps_turn = True
                    return self._inbox.take_skipped(), partial(self._match, scan.message)
                if can_step:
                    return [], self._step
                due_s = self._inbox.due_s()
                is_timed = not lives_in_virtual_time()  # there, what comes next ends the wait
                timeout_s = max(due_s - now_s, 0.0) if due_s is not None and is_timed else None
                self._changed.wait(timeout_s)
            return [], None

    def _step(self) -> None:
        """Run one step of the oldest work; if it has to wait, block until the next wake()."""
        with self._changed:
            steps = self._steps[0]
            self._may_step = self._steps_turn = False
        goes_on = next(steps, None)
        with self._changed:
            if goes_on is None:
                self._steps.popleft()
            self._may_step = self._may_step or goes_on is not False
