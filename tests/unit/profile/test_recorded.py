# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of made traces of our own, with known times."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.profile.periods import nominal_ns
from rmw_manycore_py.profile.recorded import profile_of
from rmw_manycore_py.profile.summary import summary_of
from rmw_manycore_py.trace.events import (
    EVENT,
    NO_ENDPOINT,
    Endpoint,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_id,
)
from support.samples.traces import (
    FILTER_IN,
    FILTER_OUT,
    INCARNATION,
    NAMES,
    US,
    event,
    publish,
    take,
)

pytestmark = pytest.mark.unit

SERVER, TIMED, LOG, CAMERA = 5, 6, 7, 1
ENDPOINTS = {
    **{
        slot: (is_publisher, "topic", topic, node)
        for slot, (is_publisher, topic, node) in NAMES.items()
    },
    SERVER: (False, "request", "/set", "/filter"),
    TIMED: (True, "topic", "/status", "/filter"),
    LOG: (True, "topic", "/rosout", "/filter"),
}


def trace_of(*threads: list, lost: int = 0) -> Trace:
    """Return a trace of one process with some threads."""
    endpoints = {
        endpoint_id(slot, INCARNATION): Endpoint(is_publisher, role, topic, "type", node, 1)
        for slot, (is_publisher, role, topic, node) in ENDPOINTS.items()
    }
    made = tuple(
        Thread(100 + number, "python", np.array(rows, EVENT), lost)
        for number, rows in enumerate(threads)
    )
    process = Process(1, 7, 2, 0, "filter", False, True, made, 0)
    return Trace("test", (process,), endpoints, 0)


def wait(
    begin_us: int, end_us: int, cpu_us: tuple[int, int], *, ready: bool = True, timeout_us: int = 0
) -> list:
    """Return a wait, with the CPU time of the thread at begin and end."""
    return [
        event(begin_us, Kind.WAIT_BEGIN, NO_ENDPOINT, cpu_us[0] * US, timeout_us * US),
        event(end_us, Kind.WAIT_END, NO_ENDPOINT, cpu_us[1] * US, int(ready)),
    ]


def profiled(*threads: list, until_us: int = 100_000) -> Profile:
    return profile_of(trace_of(*threads), 0, until_us * US)


def test_a_subscription_has_wall_time_cpu_time_and_publications() -> None:
    rows = []
    for i in range(10):
        t = 10_000 * i
        # Woken at 1,000; claims at 1,010, has the message at 1,013, publishes at 1,500; waits at
        # 2,013: half of that time on a CPU.
        rows += wait(t, t + 1000, (700 * i, 700 * i))
        rows += take(t + 1010, FILTER_IN, i, CAMERA) + publish(t + 1500, FILTER_OUT, i)
        rows += [event(t + 2013, Kind.WAIT_BEGIN, NO_ENDPOINT, (700 * i + 506) * US)]
    profile = profiled(rows)
    (callback,) = profile.callbacks
    assert (callback.kind, callback.trigger, callback.executions) == ("subscription", "/image", 10)
    assert callback.node is not None
    assert profile.nodes[callback.node].name == "/filter"
    assert callback.wall_ns is not None
    assert callback.wall_ns.mean == 1000 * US
    assert callback.cpu_ns is not None
    assert callback.cpu_ns.mean == pytest.approx(506 / 1013 * 1000 * US, abs=1)
    assert callback.load_cpus == pytest.approx(10 * callback.cpu_ns.mean / 1e8)
    assert callback.interval_ns is not None
    assert callback.interval_ns.mean == 10_000 * US
    (output,) = callback.publishes
    assert output.offset_ns is not None
    assert (output.count, output.offset_ns.mean) == (10, (1500 - 1013) * US)
    publisher = profile.publishers[output.publisher]
    assert (publisher.topic, publisher.publications) == ("/small", 10)
    assert publisher.size_bytes is not None
    assert publisher.size_bytes.mean == 60
    assert profile.processes[0].name == "filter"


def test_work_before_the_first_take_is_a_timer() -> None:
    rows = []
    for i in range(4):
        t = 20_000 * i
        rows += wait(t, t + 100, (0, 0)) + publish(t + 200, TIMED, i)
        if i % 2:
            rows += publish(t + 300, LOG, i)
        rows += take(t + 1000, FILTER_IN, i, CAMERA)
        rows += wait(t + 1500, t + 9000, (0, 0), ready=False)  # a timer that publishes nothing
        rows += wait(t + 9300, t + 9400, (0, 0))  # a guard condition, or the executor's own work
    rows.append(event(90_000, Kind.WAIT_BEGIN, NO_ENDPOINT))
    callbacks = {(one.kind, len(one.publishes)): one for one in profiled(rows).callbacks}
    assert set(callbacks) == {("timer", 2), ("subscription", 0), ("timer", 0)}
    timer = callbacks["timer", 2]
    assert (timer.executions, timer.period_ns) == (4, 20_000 * US)
    assert timer.wall_ns is not None
    assert timer.wall_ns.mean == 900 * US
    silent = callbacks["timer", 0]
    assert silent.node == timer.node
    assert silent.wall_ns is not None
    assert silent.wall_ns.mean == 300 * US


def test_cpu_time_in_no_callback_is_the_rest_of_the_process() -> None:
    rows = []
    for i in range(10):
        t = 1000 * i
        # 20 us of CPU time in the wait, 13 from its end to the message, 100 in the callback. Then
        # 40 in another wait, and 7 in a turn without a callback.
        used = 1000 + 180 * i
        rows += wait(t, t + 500, (used, used + 20))
        rows += take(t + 510, FILTER_IN, i, CAMERA)
        rows += wait(t + 613, t + 900, (used + 133, used + 173))
    rows += wait(10_000, 10_001, (2800, 2800))
    assert profiled(rows).processes[0].rest_ns == pytest.approx(67 * US, rel=0.001)
    assert profiled(take(0, FILTER_IN, 1, CAMERA) * 3).processes[0].rest_ns is None


def test_receive_threads_have_their_cpu_time_per_message() -> None:
    rows = []
    for i in range(11):
        rows.append(event(100 * i, Kind.RECEIVE, FILTER_OUT, i, 1))
        rows.append(event(100 * i, Kind.CPU, NO_ENDPOINT, 0, 50 * US * i))
    used = [row for row in rows if row[-1] == Kind.CPU]  # of the process, whoever reads it
    threads = tuple(
        Thread(9 + number, "manycore_rt_1", np.array(own, EVENT), 0)
        for number, own in enumerate((rows, used))
    )
    process = Process(1, 9, None, 0, "receive thread", True, True, threads, 0)
    trace = trace_of([])
    profile = profile_of(Trace("test", (*trace.processes, process), trace.endpoints, 0), 0, 10**9)
    assert profile.receive_ns == pytest.approx(500 / 11 * US)
    assert profiled([]).receive_ns is None


def test_a_timer_has_the_period_that_rcl_waits_for() -> None:
    rows = []
    for i in range(20):
        if i % 5 == 3:
            continue  # missed
        due_us = 20_000 * i + 10_000
        # Begins late, up to half a period; rcl read the clock 1 us before a wait in three.
        late_us = 700 * (13 * i % 14)
        due = {"timeout_us": 5000 + (i % 3 == 0)}
        rows += wait(due_us - 5000, due_us + late_us, (0, 0), ready=False, **due)
        rows += publish(due_us + late_us + 100, TIMED, i)
    rows.append(event(600_000, Kind.WAIT_BEGIN, NO_ENDPOINT))
    (timer,) = profiled(rows, until_us=600_000).callbacks
    assert timer.interval_ns is not None
    assert timer.interval_ns.mean != pytest.approx(20_000 * US, rel=0.1)
    assert timer.period_ns == 20_000 * US


def test_a_timer_that_begins_to_publish_is_one_timer() -> None:
    rows = []
    for i in range(30):
        due_us = 20_000 * i + 10_000
        rows += wait(due_us - 5000, due_us + 40, (0, 0), ready=False, timeout_us=5000)
        if i >= 10:
            rows += publish(due_us + 100, TIMED, i)
        if i % 10 == 9:
            rows += publish(due_us + 200, LOG, i)
        other_us = due_us + 7000  # another timer of the same period
        rows += wait(due_us + 300, other_us + 40, (0, 0), ready=False, timeout_us=6700)
        rows += publish(other_us + 100, FILTER_OUT, i)
    rows.append(event(700_000, Kind.WAIT_BEGIN, NO_ENDPOINT))
    timers = profiled(rows, until_us=700_000).callbacks
    assert [(one.executions, one.period_ns) for one in timers] == [(30, 20_000 * US)] * 2
    counts = [sorted(output.count or 0 for output in one.publishes) for one in timers]
    assert sorted(counts) == [[3, 20], [30]]


@pytest.mark.parametrize("period_ns", [33_333_333, 10_005_000, 2_500_000])
def test_a_known_period_is_not_rounded(period_ns: int) -> None:
    due_ns = [(5 + number) * period_ns + number % 2 for number in range(50)]
    assert nominal_ns(due_ns, 1.2 * period_ns) == pytest.approx(period_ns, abs=1)


def test_a_measured_period_is_rounded() -> None:
    assert nominal_ns((), 99_991_234.5) == 100_000_000
    assert nominal_ns((0,), 33_331_234.5) == 33_331_234


def test_a_request_triggers_a_service() -> None:
    rows = [*wait(0, 10, (0, 0)), *take(20, SERVER, 1, 9), *wait(50, 60, (5, 5))]
    (callback,) = profiled(rows).callbacks
    assert (callback.kind, callback.trigger) == ("service", "/set")


def test_other_threads_of_a_pool_count_without_cpu_time() -> None:
    pool = [
        row
        for i in range(3)
        for row in take(100 * i, FILTER_IN, i, CAMERA) + publish(100 * i + 10, FILTER_OUT, i)
    ]
    profile = profiled(pool, publish(5, TIMED, 1))
    (callback,) = profile.callbacks
    assert (callback.executions, callback.cpu_ns, callback.threads) == (2, None, (0,))
    assert profile.coverage.unfinished == 1
    assert profile.coverage.publications_outside_callbacks == 1
    assert profile.processes[0].threads == 2
    assert summary_of(profile)["publications"] == 4


def test_what_lies_outside_the_time_does_not_count() -> None:
    rows = []
    for i in range(10):
        t = 1000 * i
        rows += wait(t, t + 10, (0, 0)) + take(t + 20, FILTER_IN, i, CAMERA)
    (callback,) = profile_of(trace_of(rows), 2000 * US, 6000 * US).callbacks
    assert callback.executions == 4


def test_lost_events_are_counted() -> None:
    assert profile_of(trace_of([], lost=3), 0, 1).coverage.discarded_events == 3


def test_callbacks_between_two_readings_share_the_cpu_time() -> None:
    rows = [*wait(0, 1000, (50, 50))]  # us of CPU time
    rows += take(1001, FILTER_IN, 1, CAMERA)  # until 1,104: 100 us
    rows += wait(1104, 1120, (0, 0))  # not read: too soon
    rows += take(1120, SERVER, 1, 9)  # until 1,423: 300 us
    rows += wait(1423, 1500, (50 + 204, 300))  # 204 of 407 us
    callbacks = {one.kind: one for one in profiled(rows).callbacks}
    shares = {}
    for kind, callback in callbacks.items():
        assert callback.wall_ns is not None
        assert callback.cpu_ns is not None
        shares[kind] = (callback.wall_ns.mean / US, callback.cpu_ns.mean / callback.wall_ns.mean)
    assert shares == {
        "subscription": (100, pytest.approx(204 / 407, abs=1e-4)),
        "service": (300, pytest.approx(204 / 407, abs=1e-4)),
    }
