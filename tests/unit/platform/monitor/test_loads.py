# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rates are differences of two samples, also if endpoints appeared or left in between."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.picture.marks import topic_text
from rmw_manycore_py.platform.monitor.events import deaths
from rmw_manycore_py.platform.monitor.graph import Endpoint, Graph, Member
from rmw_manycore_py.platform.monitor.loads import Loads, TopicLoad
from rmw_manycore_py.platform.monitor.losses import Losses
from rmw_manycore_py.platform.monitor.sample import Sample, aligned
from rmw_manycore_py.ros.qos import policies_of

pytestmark = pytest.mark.unit

TALKER = Member(0, 70, 1, 2, 0, "talker", ("/talker",))
LISTENER = Member(1, 71, 2, None, None, "listener", ("/listener",))


def endpoint(number: int, kind: Any, topic: str = "/t", role: Any = "topic") -> Endpoint:
    node = "/talker" if kind == "publisher" else "/listener"
    return Endpoint(number, kind, role, topic, "std_msgs/msg/String", node, 0, policies_of(Qos()))


def sample(time_s: float, rows: list[tuple[Endpoint, list[int]]], cpu_ns: dict[int, int]) -> Sample:
    graph = Graph("p", 5, 16, 1 << 20, (TALKER, LISTENER), tuple(end for end, _ in rows))
    counts = np.zeros((len(rows), 13), dtype=np.int64)
    for row, values in enumerate(values for _, values in rows):
        counts[row, : len(values)] = values
    cluster: Any = SimpleNamespace(id=1, messages=int(10 * time_s), receive_thread_pid=9)
    return Sample(time_s, graph, (cluster,), counts, cpu_ns)


A, B = endpoint(1, "publisher"), endpoint(2, "publisher")
C, SERVICE = endpoint(3, "subscription"), endpoint(4, "publisher", "/s", "request")
LOADS = Loads(
    sample(10.0, [(A, [5, 50]), (C, [1, 10, 1])], {70: 1_000_000_000}),
    sample(
        12.0,
        [
            (SERVICE, [100, 100]),
            (B, [2, 20]),
            (C, [3, 30, 4, 6, 0, 0, 0, 0, 0, 3, 10, 2]),
            (A, [9, 90]),
        ],
        {70: 1_500_000_000, 71: 7},
    ),
)


def test_rates_are_differences() -> None:
    (name,), (load,) = LOADS.topics.keys(), LOADS.topics.values()
    assert name == "/t"
    assert (load.rate_hz, load.bytes_per_s, load.message_bytes) == (3.0, 30.0, 10.0)
    assert (load.queued, load.capacity, load.fill) == (3, 10, 0.3)
    assert (load.lost, load.losses_per_s, load.superseded) == (4, 1.5, 6)


def test_a_queue_for_the_newest_message_is_never_full() -> None:
    after = sample(2.0, [(A, [9, 9]), (C, [9, 9, *[0] * 7, 1, 1])], {})
    one = Loads(sample(1.0, [(A, [1, 1])], {}), after)
    (load,) = one.topics.values()
    assert (load.queued, load.capacity, load.fill) == (0, 0, 0.0)


LARGE = 1 << 20


@pytest.mark.parametrize(
    ("published", "taken", "copies"),
    [
        ([4, 4 * LARGE], [8, 8 * LARGE], 2.0),
        ([4, 4 * LARGE], [8, 8 * LARGE, 0, 0, 0, 0, 0, 0, 6], 1.25),
        ([4, 4 * LARGE, 0, 0, 0, 0, 0, 0, 4], [8, 8 * LARGE, 0, 0, 0, 0, 0, 0, 8], 0.0),
        ([4, 4 * LARGE], [0, 0], None),
        ([4, 40], [8, 80], None),
    ],
)
def test_copies_are_those_of_the_publisher_and_of_a_subscription(
    published: list[int], taken: list[int], copies: float | None
) -> None:
    before = sample(0.0, [(A, []), (C, [])], {})
    loads = Loads(before, sample(1.0, [(A, published), (C, taken)], {}))
    assert loads.copies.get("/t") == copies


def test_memory_that_readers_hold_is_that_of_the_publishers() -> None:
    rows = [(A, [*([0] * 12), 7]), (B, [*([0] * 12), 5]), (C, [*([0] * 12), 7])]
    assert Loads(sample(0.0, [], {}), sample(1.0, rows, {})).held_bytes == {"/t": 12}


def published(messages: int, size_bytes: int, seconds: float) -> TopicLoad:
    loads = Loads(
        sample(0.0, [(A, [0, 0])], {}),
        sample(seconds, [(A, [messages, messages * size_bytes])], {}),
    )
    assert topic_text(loads.topics["/t"], None) == topic_text(loads.rounded_topics["/t"], None)
    return loads.rounded_topics["/t"]


def test_rounded_loads_are_equal_where_no_other_text_is_shown() -> None:
    random = np.random.default_rng(1)
    for messages in random.integers(0, 10**5, 300).tolist():
        published(messages, int(random.integers(0, 10**7)), float(random.uniform(0.5, 4)))
    assert published(4, 100, 2.0) == published(4, 100, 2.01)
    assert published(4, 100, 2.0) != published(5, 100, 2.0)


def test_cpu_time_is_that_since_the_sample_before() -> None:
    assert LOADS.cpu_share(70) == 0.25
    assert LOADS.cpu_share(71) == 0.0, "it was not there before"
    assert LOADS.receive_thread_rates_hz() == {1: 10.0}


def test_deaths_are_reported() -> None:
    (death,) = deaths([TALKER])
    assert death.text == "/talker died (pid 70, cluster 1 core 2)"


def test_losses_and_missed_deadlines_are_reported() -> None:
    assert [(one.kind, one.text) for one in Losses().events_of(LOADS)] == [
        ("lost", "/t: 3 lost by /listener"),
        ("deadline", "/t: /listener missed its deadline 2 times"),
    ]


def test_what_goes_on_is_summed_up() -> None:
    """The first message at once, then the count of ten seconds; after a pause the first again."""
    losses = Losses()
    lost, told = 0, []
    samples = [sample(0.0, [(C, [0, 0, 0])], {})]
    for second in range(1, 41):
        lost += 3 if second <= 15 or second == 40 else 0
        samples.append(sample(float(second), [(C, [0, 0, lost])], {}))
        told += [(second, one.text) for one in losses.events_of(Loads(*samples[-2:]))]
    assert told == [
        (1, "/t: 3 lost by /listener"),
        (11, "/t: 30 lost by /listener in 10 s"),
        (21, "/t: 12 lost by /listener in 10 s"),
        (40, "/t: 3 lost by /listener"),
    ]
    assert list(losses.rest(40.0)) == []


def test_unreported_changes_are_reported_at_the_end() -> None:
    losses = Losses()
    samples = [sample(float(n), [(C, [0, 0, 3 * n])], {}) for n in range(3)]
    assert len(list(losses.events_of(Loads(*samples[:2])))) == 1
    assert list(losses.events_of(Loads(*samples[1:]))) == []
    (rest,) = losses.rest(4.0)
    assert rest.text == "/t: 3 lost by /listener in 3 s"


def test_a_first_look_has_no_rates() -> None:
    load = Loads(LOADS.after, LOADS.after).topics["/t"]
    assert (load.rate_hz, load.lost) == (0.0, 4)


def test_counts_are_found_by_their_endpoint() -> None:
    ids = np.array([7, 3, 5], dtype=np.uint64)
    known = np.array([5, 7, 9], dtype=np.uint64)
    counts = np.array([[50], [70], [90]], dtype=np.int64)
    assert aligned(ids, known, counts).tolist() == [[70], [0], [50]]
    assert aligned(known, known, counts) is counts
    assert aligned(ids, known[:0], counts[:0]).tolist() == [[0], [0], [0]]
