# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the bench of the whole node plays, and how it reads the replay's table."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rmw_manycore_py.bench.ndt import node
from rmw_manycore_py.bench.ndt.driven import Scenario
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


def test_a_run_without_any_pose_is_one_that_lost_all():
    (lost,) = node.results(node.ALONE, [{"state": "lost", "latency_ms": ""}] * 3)
    assert lost.samples == (3.0,)


def test_the_node_s_mapfile_is_one(tmp_path: Path):
    path = tmp_path / "map.yaml"
    path.write_text(json.dumps(Scenario({"realtime_priority": 3}).mapfile(tmp_path)))
    played = load_mapfile(path).sections.nodes["ndt_scan_matcher"]
    assert played.parameters["realtime_priority"] == 3
    assert played.respawn.delay == 0
