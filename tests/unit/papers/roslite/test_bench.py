# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the bench of ROS-lite makes of its measurements: relations, sizes, drives."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from rmw_manycore_py.bench.relations import measured_relations
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.roslite.bench import end_to_end, memory, sending, split
from rmw_manycore_py.papers.roslite.bench.claims import CLAIMS
from rmw_manycore_py.papers.roslite.bench.elf import Sizes, sizes_of
from rmw_manycore_py.papers.roslite.bench.figures import draw
from rmw_manycore_py.papers.roslite.bench.sending import sending_us
from rmw_manycore_py.papers.roslite.vehicle.drive_log import DriveFigures, DriveLog
from support.samples.traces import example

pytestmark = pytest.mark.unit

BEFORE, AFTER = end_to_end.BEFORE, end_to_end.AFTER
# Medians as the paper has them.
PAPER = {
    **{
        (sending.question_of(node, waypoints), transfer): time_us
        for node, times in {
            "lane_select": {"message": 4000.0, "session": 1000.0},
            "pure_pursuit": {"message": 100.0, "session": 110.0},
            "twist_filter": {"message": 100.0, "session": 95.0},
        }.items()
        for transfer, time_us in times.items()
        for waypoints in sending.LANES
    },
    **{
        (split.QUESTION, split.contender(derivatives, searches)): 60.0 / derivatives / searches
        for derivatives in split.DERIVATIVES
        for searches in split.SEARCHES
    },
    (end_to_end.ALIGNMENT, BEFORE): 1000.0,
    (end_to_end.ALIGNMENT, AFTER): 20.0,
    (end_to_end.PASSES, AFTER): 5.0,
    (end_to_end.COMMAND, BEFORE): 1100.0,
    (end_to_end.COMMAND, AFTER): 80.0,
    (end_to_end.LATE, AFTER): 0.0,
    (memory.SMEM, memory.LEFT): 1024.0,
}


def holds(medians: dict[tuple[str, str], float]) -> dict[str, bool]:
    return {found.name: found.holds for found in measured_relations(CLAIMS, medians)}


def test_all_relations_hold_for_figures_like_the_papers():
    assert holds(PAPER) == dict.fromkeys((claim.name for claim in CLAIMS), True)


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        ("Fig. 13a", (sending.question_of("twist_filter", 1000), "session"), 120.0),
        ("Fig. 13a", (sending.question_of("pure_pursuit", 4000), "session"), 80.0),
        ("Fig. 13b", (sending.question_of("lane_select", 1000), "session"), 4000.0),
        ("Fig. 13b", (sending.question_of("lane_select", 4000), "message"), 1000.0),
        ("Fig. 14", (end_to_end.ALIGNMENT, AFTER), 100.0),
        ("Fig. 14", (end_to_end.ALIGNMENT, AFTER), 2.0),
        ("Fig. 15a", (split.QUESTION, split.contender(4, 3)), 7.0),
        ("Fig. 15b", (end_to_end.PASSES, AFTER), 6.0),
        ("Fig. 16a", (end_to_end.COMMAND, AFTER), 1100.0),
        ("Fig. 16b", (end_to_end.LATE, AFTER), 1.0),
        ("Table I", (memory.SMEM, memory.LEFT), 900.0),
    ],
)
def test_a_relation_does_not_hold_for_another_figure(name, key, value):
    found = holds({**PAPER, key: value})
    assert [claim for claim, holds_here in found.items() if not holds_here] == [name]


def test_relations_that_were_not_measured_are_left_out():
    some = {key: value for key, value in PAPER.items() if key[0] == end_to_end.COMMAND}
    assert holds(some) == {"Fig. 16a": True}


def test_each_figure_is_drawn_from_its_results(tmp_path):
    results = [Result(*key, "ms", (value, 2 * value)) for key, value in PAPER.items()]
    names = [path.name for path in draw(results, tmp_path)]
    assert names == [f"figure_{name}.svg" for name in ("13_1000", "13_4000", "14", "16", "15")]
    assert all((tmp_path / name).read_text().startswith("<?xml") for name in names)
    assert draw(results[-1:], tmp_path) == []


def test_the_sizes_of_a_program_are_those_of_its_segments(tmp_path):
    """Built by hand: read-only 100, code 1000, data 40 of 64 in memory, and a note."""
    segments = [(1, 4, 100, 100), (1, 5, 1000, 1000), (1, 6, 40, 64), (4, 4, 7, 7)]
    table = b"".join(
        struct.pack("<IIQQQQQQ", kind, flags, 0, 0, 0, in_file, in_memory, 0)
        for kind, flags, in_file, in_memory in segments
    )
    head = b"\x7fELF\x02\x01".ljust(32, b"\0") + struct.pack("<Q", 80) + bytes(14)
    head += struct.pack("<HH", 56, len(segments)) + bytes(6)
    path = tmp_path / "program"
    path.write_bytes(head.ljust(80, b"\0") + table)
    assert sizes_of(path) == Sizes(text=1100, bss=24, data=40)
    path.write_text("#!/bin/sh")
    assert sizes_of(path) is None


def test_what_a_message_waits_for_a_busy_node_does_not_count():
    """In the example, 11 us pass until the hint, then 19 until a take of 3."""
    assert sending_us(example(rounds=3)) == {"/image": [14.0] * 3}


def test_only_the_first_command_from_a_counted_scan_matters(tmp_path: Path):
    log = DriveLog()
    log.commanded(5, 6)  # before the count
    for stamp in (1_000_000, 2_000_000, 3_000_000):
        log.sent(stamp)
    log.commanded(1_000_000, 41_000_000)
    log.commanded(1_000_000, 90_000_000)
    log.commanded(2_000_000, 103_000_000)
    log.planned(2_000_000, 52_000_000)
    log.planned(9, 52_000_000)
    log.loops.append((30.0, 4))
    log.figures().write(tmp_path / "drive.json")
    found = DriveFigures.read(tmp_path / "drive.json")
    assert (found.scans, found.lost, found.late) == (3, 1, 2)
    assert found.to_command_ms == [40.0, 101.0]
    assert found.to_plan_ms == [50.0]
    assert found.loop_ms == [7.5]
