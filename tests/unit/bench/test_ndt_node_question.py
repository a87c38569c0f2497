# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The bench of the whole node: what it replays, and how it reads the replay's table."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rmw_manycore_py.bench.ndt import node
from rmw_manycore_py.bench.ndt.driven import Scenario
from rmw_manycore_py.bench.summary import Result, judge
from rmw_manycore_py.mapfile import load_mapfile

pytestmark = pytest.mark.unit


def test_scans_without_a_pose_are_counted_and_have_no_latency():
    rows = [
        {"state": "answered", "latency_ms": "7.5"},
        {"state": "late", "latency_ms": "120.0"},
        {"state": "lost", "latency_ms": ""},
    ]
    latency, lost = node.results(node.KILLED, rows)
    assert (latency.question, latency.samples) == (node.LATENCY, (7.5, 120.0))
    assert (lost.question, lost.samples) == (node.LOST, (1.0,))


def test_errors_and_cpu_time_of_a_run():
    rows = [
        {"state": "answered", "latency_ms": "7.5", "error_m": "0.02", "cpu_time_s": "1.50"},
        {"state": "lost", "latency_ms": "", "error_m": "", "cpu_time_s": ""},
        {"state": "answered", "latency_ms": "8.5", "error_m": "0.04", "cpu_time_s": "1.60"},
    ]
    found = {result.question: result.samples for result in node.results(node.SIZED, rows)}
    assert found[node.ERROR] == pytest.approx((2.0, 4.0))
    assert found[node.CPU] == pytest.approx((50.0,))
    rows[2]["cpu_time_s"] = "0.40"  # killed meanwhile
    assert node.CPU not in {result.question for result in node.results(node.KILLED, rows)}


def test_the_node_s_part_of_the_way_is_given_beside_it():
    rows = [
        {"state": "answered", "latency_ms": "9.5", "execution_time": "6.25"},
        {"state": "lost", "latency_ms": "", "execution_time": "6.5"},  # refused after matching
        {"state": "lost", "latency_ms": "", "execution_time": ""},
    ]
    found = {result.question: result.samples for result in node.results(node.ALONE, rows)}
    assert found[node.EXECUTION] == (6.25, 6.5)


def test_maps_that_delay_scans_miss_their_goals():
    def run(name: str, slowest_ms: float, lost: int) -> list[Result]:
        times_ms = [6.0] * 97 + [slowest_ms] * 3
        rows = [
            {"state": "answered", "latency_ms": str(3.0 + ms), "execution_time": str(ms)}
            for ms in times_ms
        ]
        return node.results(name, rows + lost * [{"state": "lost", "latency_ms": ""}])

    def missed(slowest_ms: float, lost: int) -> set[str]:
        found = run(node.ALONE, 10.0, 0) + run(node.SWAPPED, slowest_ms, lost)
        verdicts = judge(found, node.QUESTION.goals)
        return {verdict.goal.question for verdict in verdicts if not verdict.reached}

    assert missed(12.0, 0) == set()
    assert missed(120.0, 0) == {node.LATENCY, node.EXECUTION}
    assert missed(12.0, 1) == {node.LOST}


def test_a_run_without_any_pose_is_one_that_lost_all():
    (lost,) = node.results(node.ALONE, [{"state": "lost", "latency_ms": ""}] * 3)
    assert lost.samples == (3.0,)


def test_the_node_s_mapfile_is_one(tmp_path: Path):
    path = tmp_path / "map.yaml"
    path.write_text(json.dumps(Scenario({"realtime_priority": 3}).mapfile(tmp_path)))
    played = load_mapfile(path).sections.nodes["ndt_scan_matcher"]
    assert played.parameters["realtime_priority"] == 3
    assert played.respawn.delay == 0
