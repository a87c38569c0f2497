# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of LTTng traces: what the events say, beside what babeltrace2 prints of them."""

from __future__ import annotations

import os
from itertools import count

import pytest

from rmw_manycore_py.errors import FileError, ManycoreError
from rmw_manycore_py.profile.model import Callback, Profile
from rmw_manycore_py.profile.ros2_tracing import Window, import_trace
from rmw_manycore_py.profile.summary import summary_of
from support.generated.ctf import (
    FROM_TIMER,
    FROM_TOPIC,
    MS,
    NODE,
    SUBSCRIPTION,
    SYMBOL,
    Made,
    begin,
    end,
    made,
    node,
    published,
    subscription,
    timer,
    write_trace,
)

pytestmark = [pytest.mark.unit, pytest.mark.needs("babeltrace2")]


@pytest.fixture
def imported(tmp_path):
    """Return a function that imports a trace of some events."""
    numbers = count()

    def call(*events: Made, **options) -> Profile:
        ordered = sorted(events, key=lambda event: event.time_ns)
        return import_trace(
            write_trace(tmp_path / str(next(numbers)), ordered, **options), Window()
        )

    return call


def only(profile: Profile) -> Callback:
    (callback,) = profile.callbacks
    return callback


def test_a_callback_has_trigger_times_and_publications(imported) -> None:
    events = [*node(1, "filter"), *subscription(1, "/in")]
    for at_ms in (10, 20, 40):
        events += [begin(at_ms, 1, 2, FROM_TOPIC), published(at_ms + 1, 1, 2)]
        events += [published(at_ms + 2, 1, 2), end(at_ms + 4, 1, 2, FROM_TOPIC)]
    profile = imported(*events)
    callback = only(profile)
    assert (callback.kind, callback.trigger, callback.symbol) == ("subscription", "/in", SYMBOL)
    assert callback.node is not None
    assert profile.nodes[callback.node].name == "/ns/filter"
    assert callback.subscription is not None
    assert profile.subscriptions[callback.subscription].queue_depth == 7
    assert callback.executions == 3
    assert callback.wall_ns is not None
    assert callback.wall_ns.quantiles == (4.0 * MS,) * 25
    assert callback.interval_ns is not None
    assert (callback.interval_ns.count, callback.interval_ns.mean) == (2, 15 * MS)
    (output,) = callback.publishes
    assert profile.publishers[output.publisher].topic == "/out"
    assert profile.publishers[output.publisher].node == callback.node
    assert output.offset_ns is not None
    assert (output.count, output.offset_ns.mean) == (6, 1.5 * MS)
    summary = summary_of(profile)
    assert (summary["duration_s"], summary["cpus_busy"]) == (0.044, pytest.approx(12 / 44))
    assert summary["events"] == len(events)


def test_the_age_of_a_message_is_that_of_its_chain(imported) -> None:
    """Camera, filter, sink; the sink's age is from the camera's publication, by a timer."""
    events = [
        *node(1, "camera", topic="/image"), *timer(1),
        *node(2, "filter", topic="/small"), *subscription(2, "/image"),
        *node(3, "sink"), *subscription(3, "/small"),
    ]  # fmt: skip
    for at_ms in (100, 200, 300):
        events += [begin(at_ms, 1, 1, FROM_TIMER), published(at_ms + 1, 1, 1)]
        events += [end(at_ms + 2, 1, 1, FROM_TIMER), begin(at_ms + 3, 2, 2, FROM_TOPIC)]
        events += [published(at_ms + 10, 2, 2), end(at_ms + 11, 2, 2, FROM_TOPIC)]
        events += [begin(at_ms + 14, 3, 3, FROM_TOPIC), end(at_ms + 15, 3, 3, FROM_TOPIC)]
    found = {}
    for one in imported(*events).callbacks:
        if one.age_ns is not None and one.queued_ns is not None:
            found[one.trigger] = (one.queued_ns.mean / MS, one.age_ns.mean / MS, one.age_ns.count)
    assert found == {"/image": (2, 2, 3), "/small": (4, 13, 3)}


def test_timers_and_services_are_triggers(imported) -> None:
    service = [
        made(0, "rcl_service_init", 1, 1, service_handle=9, node_handle=NODE, service_name="/s"),
        made(0, "rclcpp_service_callback_added", 1, 1, service_handle=9, callback=8),
    ]
    runs = [
        begin(1, 1, 1, FROM_TIMER),
        end(2, 1, 1, FROM_TIMER),
        begin(3, 1, 1, 8),
        end(4, 1, 1, 8),
    ]
    callbacks = imported(*node(1, "n"), *timer(1), *service, *runs).callbacks
    assert [(one.kind, one.trigger, one.period_ns) for one in callbacks] == [
        ("timer", "", 20 * MS),
        ("service", "/s", None),
    ]
    assert {one.node for one in callbacks} == {0}


def test_an_address_means_another_callback_in_another_process(imported) -> None:
    events = [*node(1, "a"), *subscription(1, "/one"), *node(2, "b"), *subscription(2, "/two")]
    for pid in (1, 2, 2):
        events += [begin(pid, pid, pid, FROM_TOPIC), end(pid + 0.5, pid, pid, FROM_TOPIC)]
    events[-2:] = [begin(5, 2, 2, FROM_TOPIC), end(6, 2, 2, FROM_TOPIC)]
    profile = imported(*events)
    assert [(one.trigger, one.executions, one.node) for one in profile.callbacks] == [
        ("/one", 1, 0),
        ("/two", 2, 1),
    ]


def test_a_later_entity_at_the_same_address_is_another_one(imported) -> None:
    profile = imported(
        *node(1, "n"), *subscription(1, "/first"),
        begin(1, 1, 1, FROM_TOPIC), end(2, 1, 1, FROM_TOPIC),
        *subscription(1, "/second", at_ns=3 * MS),
        begin(4, 1, 1, FROM_TOPIC), end(5, 1, 1, FROM_TOPIC),
    )  # fmt: skip
    assert [one.trigger for one in profile.callbacks] == ["/first", "/second"]


def test_the_log_publisher_belongs_to_the_node_that_follows_it(imported) -> None:
    events = [
        *node(1, "first"), *node(1, "second"),  # at the same address: the first one is gone
        *subscription(1, "/in"), begin(1, 1, 1, FROM_TOPIC), end(2, 1, 1, FROM_TOPIC),
    ]  # fmt: skip
    rosout = [one.node for one in imported(*events).publishers if one.topic == "/rosout"]
    assert rosout == [0, 1]


def test_a_callback_around_others_is_not_an_execution(imported) -> None:
    """It runs an executor: most of its time, it waits."""
    profile = imported(
        *node(1, "n"), *subscription(1, "/in"), *timer(1),
        begin(1, 1, 1, FROM_TIMER), begin(10, 1, 1, FROM_TOPIC), published(11, 1, 1),
        end(12, 1, 1, FROM_TOPIC), published(50, 1, 1), end(99, 1, 1, FROM_TIMER),
        begin(100, 1, 1, FROM_TIMER), end(101, 1, 1, FROM_TIMER),
    )  # fmt: skip
    assert {one.kind: one.executions for one in profile.callbacks} == {
        "timer": 1,
        "subscription": 1,
    }
    assert profile.coverage.enclosing == 1
    # Two callbacks of the node ran at 11 ms, one at 50 ms.
    assert profile.coverage.ambiguous_publications == 1
    assert summary_of(profile)["publications"] == 2


def test_publications_are_attributed_by_thread_and_node(imported) -> None:
    profile = imported(
        *node(1, "n"), *subscription(1, "/in"), *node(1, "other", at=0x100, topic="/theirs"),
        begin(1, 1, 1, FROM_TOPIC),
        published(2, 1, 2),  # by another thread
        published(3, 1, 1, at=0x100),  # of another node
        made(4 * MS, "rcl_publish", 1, 1, publisher_handle=0xDEAD),  # of a copy on the stack
        end(5, 1, 1, FROM_TOPIC),
    )  # fmt: skip
    coverage = profile.coverage
    assert coverage.publications_outside_callbacks == 1
    assert coverage.ambiguous_publications == 1
    assert coverage.publications_of_unknown_publishers == 1
    assert summary_of(profile)["publications"] == 3
    by_topic = {one.topic: one for one in profile.publishers if one.topic != "/rosout"}
    assert (by_topic["/out"].publications, by_topic["/out"].outside_callbacks) == (1, 1)
    assert by_topic["/theirs"].publications == 1


def test_begins_and_ends_without_the_other_are_counted(imported) -> None:
    profile = imported(
        *node(1, "n"), *subscription(1, "/in"), *timer(1),
        end(1, 1, 1, FROM_TOPIC),  # begun before the trace
        begin(2, 1, 1, FROM_TOPIC), end(3, 1, 1, FROM_TOPIC),
        begin(4, 1, 1, FROM_TIMER), begin(5, 1, 1, FROM_TOPIC),  # whose end was lost
        end(6, 1, 1, FROM_TIMER),
        begin(7, 1, 1, FROM_TOPIC),  # until after the trace
    )  # fmt: skip
    coverage = profile.coverage
    assert (coverage.begun_before, coverage.unfinished, coverage.enclosing) == (1, 2, 1)
    assert only(profile).executions == 1


def test_an_unregistered_callback_is_kept_as_unknown(imported) -> None:
    callback = only(imported(*node(1, "n"), begin(1, 1, 1, 0x99), end(2, 1, 1, 0x99)))
    assert (callback.kind, callback.node, callback.executions) == ("unknown", None, 1)


def test_groups_and_executors_of_caret_are_kept(imported) -> None:
    profile = imported(
        *node(1, "n"), *subscription(1, "/in"),
        made(1, "ros2_caret:construct_executor", 1, 1, executor_addr=5,
             executor_type_name="single_threaded_executor"),
        made(2, "ros2_caret:callback_group_add_subscription", 1, 1, callback_group_addr=6,
             subscription_handle=SUBSCRIPTION),
        made(3, "ros2_caret:add_callback_group", 1, 1, executor_addr=5, callback_group_addr=6,
             group_type_name="reentrant"),
        begin(1, 1, 1, FROM_TOPIC), end(2, 1, 1, FROM_TOPIC),
    )  # fmt: skip
    assert only(profile).group == 0
    assert (profile.groups[0].kind, profile.groups[0].executor) == ("reentrant", 0)
    assert profile.executors[0].kind == "single_threaded_executor"


def test_a_window_counts_what_lies_inside(tmp_path) -> None:
    events = [*node(1, "n"), *subscription(1, "/in")]
    for at_ms in range(10, 110, 10):
        events += [begin(at_ms, 1, 1, FROM_TOPIC), end(at_ms + 1, 1, 1, FROM_TOPIC)]
    trace = write_trace(tmp_path / "trace", events)
    profile = import_trace(trace, Window(35 * MS, 80_500_000))
    assert only(profile).executions == 4
    assert profile.duration_ns == 45_500_000
    assert profile.coverage.unfinished == 1
    assert only(import_trace(trace, Window())).executions == 10


def test_discarded_events_are_counted(tmp_path) -> None:
    first = [*node(1, "n"), *subscription(1, "/in"), begin(1, 1, 1, FROM_TOPIC)]
    trace = write_trace(tmp_path / "trace", first, [end(2, 1, 1, FROM_TOPIC)], discarded=17)
    assert import_trace(trace, Window()).coverage.discarded_events == 17


def test_a_foreign_trace_is_refused(imported) -> None:
    with pytest.raises(FileError, match=r"expected events of ros2_tracing"):
        imported(made(1, "lttng_ust_statedump:start", 1, 1))
    with pytest.raises(FileError, match=r"expected the context fields vpid and vtid .* procname$"):
        imported(*node(1, "n"), context="string _procname;")


def test_a_damaged_trace_is_refused(tmp_path) -> None:
    trace = write_trace(tmp_path / "trace", [*node(1, "n"), *subscription(1, "/in")])
    stream = trace / "stream_0"
    stream.write_bytes(stream.read_bytes()[:-10])
    with pytest.raises(FileError, match=r"expected a CTF trace, found .*stream"):
        import_trace(trace, Window())
    metadata = trace / "metadata"
    metadata.write_bytes(os.urandom(500))
    with pytest.raises(FileError, match=r"expected a CTF trace, found ."):
        import_trace(trace, Window())


def test_the_missing_reader_is_named(tmp_path, monkeypatch) -> None:
    trace = write_trace(tmp_path / "trace", node(1, "n"))
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ManycoreError, match=r"apt-get install babeltrace2"):
        import_trace(trace, Window())
