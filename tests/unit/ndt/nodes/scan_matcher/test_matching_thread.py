# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The order in which scans are matched, and what continues meanwhile.

The threads are real; this does not prove that no interleaving of them loses a scan.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from rmw_manycore_py.ndt.nodes.scan_matcher.matching_thread import MatchingError, MatchingThread
from rmw_manycore_py.ndt.nodes.scan_matcher.scan_inbox import MAX_WAITING, ScanInbox

pytestmark = pytest.mark.unit

TIMEOUT_S = 60.0
LONG_S = 1e9


class Known:
    """The stamps for which a guess is known."""

    def __init__(self, *stamps_s: float) -> None:
        self.stamps_s = set(stamps_s)

    def __call__(self, stamp_s: float) -> bool:
        return stamp_s in self.stamps_s


def skipped_of(inbox: ScanInbox) -> list[str]:
    return [scan.message for scan in inbox.take_skipped()]


def test_a_scan_waits_for_its_guess_but_not_for_ever():
    inbox = ScanInbox(Known(), timeout_s=0.05)
    inbox.put("a", 1.0, now_s=10.0)
    assert inbox.take(10.04) is None
    assert inbox.due_s() == pytest.approx(10.05)
    assert inbox.take(10.05).message == "a"
    assert inbox.due_s() is None


def test_a_scan_that_waits_does_not_hold_up_the_next():
    inbox = ScanInbox(Known(2.0), timeout_s=0.05)
    inbox.put("a", 1.0, now_s=10.0)
    inbox.put("b", 2.0, now_s=10.01)
    assert inbox.take(10.01).message == "b"
    assert skipped_of(inbox) == ["a"]
    assert inbox.take(11.0) is None


def test_the_newest_of_several_is_taken_and_the_others_are_counted():
    inbox = ScanInbox(Known(1.0, 2.0, 3.0), timeout_s=0.05)
    for stamp_s, name in enumerate("abc", start=1):
        inbox.put(name, float(stamp_s), now_s=10.0)
    assert inbox.take(10.0).message == "c"
    assert skipped_of(inbox) == ["a", "b"]
    assert skipped_of(inbox) == []


def test_a_scan_with_its_guess_goes_before_a_newer_one_without():
    known = Known(1.0)
    inbox = ScanInbox(known, timeout_s=0.05)
    inbox.put("a", 1.0, now_s=10.0)
    inbox.put("b", 2.0, now_s=10.0)
    assert inbox.take(10.1).message == "a"
    assert inbox.take(10.1).message == "b"
    assert skipped_of(inbox) == []


def test_no_more_than_a_few_scans_wait():
    inbox = ScanInbox(Known(), timeout_s=LONG_S)
    for index in range(3 * MAX_WAITING):
        inbox.put(index, float(index), now_s=0.0)
    assert skipped_of(inbox) == list(range(2 * MAX_WAITING))


class Node:
    """The matcher as the thread calls it; matching blocks until the test lets it continue."""

    def __init__(self) -> None:
        self.known = Known()
        self.matched: list[str] = []
        self.skipped: list[str] = []
        self.may_match = threading.Semaphore(0)
        self.is_matching = threading.Semaphore(0)
        self.is_over = False
        self.failed = threading.Event()
        self.thread = MatchingThread(
            ScanInbox(self.known, LONG_S),
            self.match,
            self.skipped.append,
            lambda: self.is_over,
            self.failed.set,
        )

    def match(self, name: str) -> None:
        self.is_matching.release()
        assert self.may_match.acquire(timeout=TIMEOUT_S)
        if name == "broken":
            raise ValueError(name)
        self.matched.append(name)

    def run(self, job: Callable[[], None]) -> None:
        """Run a job on the thread, and wait for it."""
        done = threading.Event()
        self.thread.post(job)
        self.thread.post(done.set)
        assert done.wait(TIMEOUT_S)

    def put(self, name: str, stamp_s: float) -> None:
        self.known.stamps_s.add(stamp_s)
        self.thread.put_scan(name, stamp_s)


@pytest.fixture
def node() -> Iterator[Node]:
    node = Node()
    yield node
    for _ in range(10):
        node.may_match.release()
    if not node.failed.is_set():
        node.thread.close()


def test_guesses_get_through_while_a_scan_is_matched(node):
    """Of the scans that arrived meanwhile, all but the newest are skipped."""
    node.put("a", 1.0)
    assert node.is_matching.acquire(timeout=TIMEOUT_S)
    for stamp_s, name in enumerate("bcd", start=2):
        node.thread.put_scan(name, float(stamp_s))
        node.known.stamps_s.add(float(stamp_s))
        node.thread.wake()
    node.may_match.release()
    assert node.is_matching.acquire(timeout=TIMEOUT_S)
    node.may_match.release()
    node.run(lambda: None)
    assert node.matched == ["a", "d"]
    assert node.skipped == ["b", "c"]


def test_a_guess_wakes_the_scan_that_waits_for_it(node):
    node.thread.put_scan("a", 1.0)
    node.run(lambda: None)
    assert node.matched == []
    node.known.stamps_s.add(1.0)
    node.thread.wake()
    assert node.is_matching.acquire(timeout=TIMEOUT_S)


def test_jobs_run_between_scans_on_the_thread(node):
    found = []
    node.run(lambda: found.append(threading.current_thread().name))
    assert found == ["matching"]


def test_steps_and_scans_take_turns(node):
    """A scan that arrives during a step is matched before the next one, but only one is."""
    order, in_step, may_end = [], threading.Event(), threading.Event()

    def steps() -> Iterator[bool]:
        order.append("step")
        in_step.set()
        assert may_end.wait(TIMEOUT_S)
        yield True
        order.append(f"step after {len(node.matched)} scans")
        done.set()

    done = threading.Event()
    node.thread.post_steps(steps())
    assert in_step.wait(TIMEOUT_S)
    node.put("a", 1.0)
    may_end.set()
    assert node.is_matching.acquire(timeout=TIMEOUT_S)
    node.put("b", 2.0)
    node.may_match.release()
    assert done.wait(TIMEOUT_S)
    assert order == ["step", "step after 1 scans"]


def test_steps_that_wait_sleep_until_they_are_woken(node):
    taken, waits = [], threading.Semaphore(0)

    def steps() -> Iterator[bool]:
        for number in range(3):
            taken.append(number)
            waits.release()
            yield False

    node.thread.post_steps(steps())
    for number in range(3):
        assert waits.acquire(timeout=TIMEOUT_S)
        node.run(lambda: None)
        node.run(lambda: None)
        assert taken == list(range(number + 1))
        node.thread.wake()


def test_what_raises_after_the_end_of_the_context_is_no_failure(node):
    """Ctrl-C shuts the context down while a scan is matched: its pose cannot be published."""
    node.is_over = True
    node.put("broken", 1.0)
    node.may_match.release()
    assert node.is_matching.acquire(timeout=TIMEOUT_S)
    node.thread.close()
    assert not node.failed.is_set()


def test_an_error_of_the_thread_is_reported_and_raised(node):
    node.put("broken", 1.0)
    node.may_match.release()
    assert node.failed.wait(TIMEOUT_S)
    with pytest.raises(MatchingError, match="broken"):
        node.thread.close()
