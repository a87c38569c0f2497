# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Output of the reference system's nodes: printed in its format, and parsed again."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from manycore_reference_msgs.msg import Message4kb

from rmw_manycore_py.papers.reference_system.bench.text import losses_in, reports_in, values
from rmw_manycore_py.papers.reference_system.payload import check_payload, write_payload
from rmw_manycore_py.papers.reference_system.sample import (
    Gaps,
    add_record,
    merge_records,
    name_of,
    records_of,
)
from rmw_manycore_py.papers.reference_system.sample_path import UNCOUNTED, SamplePath
from rmw_manycore_py.papers.reference_system.statistics import Statistic

pytestmark = pytest.mark.unit

MS = 1_000_000
# The patterns of the reference system's report scripts.
LATENCY = (
    r"^ *hot path latency: *(.+)ms \[min=(.+)ms, max=(.+)ms, average=(.+)ms, deviation=(.+)ms\]$"
)
DROPS = r"^ *hot path drops: *(.+) \[min=(.+), max=(.+), average=(.+), deviation=(.+)\]$"


def message_at(cycle: int, *, drops: int = 0) -> Any:
    """Return the arrivals of a cycle: the later lidar at 10 ms, the end of the hot path at 17."""
    message = Message4kb()
    start = (1000 + 100 * cycle) * MS
    add_record(message, "FrontLidarDriver", start, cycle, 0)
    add_record(message, "RearLidarDriver", start + 10 * MS, cycle, 0)
    add_record(message, "PointCloudFusion", start + 12 * MS, cycle, drops)
    add_record(message, "ObjectCollisionEstimator", start + 17 * MS, cycle, 0)
    add_record(message, "BehaviorPlanner", start + 20 * MS, cycle, 5)
    return message


def printed(cycles: int, **options: int) -> str:
    path = SamplePath("VehicleDBWSystem")
    lines: list[str] = []
    for cycle in range(cycles):
        message = message_at(cycle, **options)
        lines += path.add(message, (1000 + 100 * cycle + 30) * MS, missed=0)
    return "\n".join(lines)


def test_the_first_messages_are_reported_without_statistics() -> None:
    reports = reports_in(printed(UNCOUNTED))
    assert len(reports) == UNCOUNTED
    assert not any(report.statistics for report in reports)
    assert reports[0].stamp_ns == 1030 * MS


def test_statistics_come_back_as_they_were_added() -> None:
    reports = reports_in(printed(UNCOUNTED + 3, drops=2))
    assert values(reports, "hot path latency") == pytest.approx([7.0] * 3)
    assert values(reports, "latency") == pytest.approx([30.0] * 3)
    assert values(reports, "hot path drops") == [2, 2, 2], "those of the planner do not count"
    assert values(reports, "behavior planner period") == pytest.approx([100.0] * 2)
    assert reports[-1].sequences["PointCloudFusion"] == UNCOUNTED + 2


def test_the_text_is_what_the_reference_systems_scripts_read() -> None:
    text = printed(UNCOUNTED + 2)
    latency = [re.match(LATENCY, line) for line in text.splitlines()]
    (first, last) = [found for found in latency if found]
    assert [float(value) for value in last.groups()] == pytest.approx([7, 7, 7, 7, 0])
    assert math.isnan(float(first[5]))
    assert len([line for line in text.splitlines() if re.match(DROPS, line)]) == 2


def test_losses_are_read_among_reports() -> None:
    text = f"lost 3 of PointCloudFusion at 17\n{printed(1)}\nlost 1 of Visualizer at 19"
    assert [(loss.count, loss.topic, loss.stamp_ns) for loss in losses_in(text)] == [
        (3, "PointCloudFusion", 17),
        (1, "Visualizer", 19),
    ]
    assert len(reports_in(text)) == 1


def test_records_of_known_nodes_are_merged_once() -> None:
    message, source = message_at(0), message_at(1)
    add_record(source, "Visualizer", 0, 0, 0)
    merge_records(message, source)
    assert [name_of(record) for record in records_of(message)][-1] == "Visualizer"
    assert message.size == 6
    assert records_of(message)[0].sequence_number == 0


def test_a_full_message_stays_as_it_is() -> None:
    message = Message4kb()
    for number in range(len(message.stats) + 1):
        add_record(message, f"node_{number}", 0, 0, 0)
    merge_records(message, message_at(0))
    assert message.size == len(message.stats)


def test_gaps_begin_with_what_comes_first() -> None:
    gaps = Gaps()
    assert [gaps.before(number) for number in (7, 8, 11, 11, 2, 3)] == [0, 0, 2, 0, 0, 0]


def test_a_payload_that_was_changed_is_refused() -> None:
    message = Message4kb()
    write_payload(message, 41)
    check_payload(message, "here")
    message.data[-1] += 1
    with pytest.raises(RuntimeError, match="here: expected a payload with the sum"):
        check_payload(message, "here")


def test_deviation_is_that_of_a_sample() -> None:
    statistic = Statistic()
    for value in (2.0, 4.0, 9.0):
        statistic.add(value)
    assert statistic.deviation == pytest.approx(math.sqrt(13))
