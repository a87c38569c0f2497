# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The whole node behind the bridge: beside load, with large scans, new maps, and after a kill."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rmw_manycore_py.bench.ndt.driven import Drive, Scenario
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.scheduling import Scheduling, refusal

NAME = "node"
LATENCY = "scan to pose, through the bridge"
LOST = "scans without a pose"
LENGTH_M = 160.0  # 200 scans at 8 m/s
LARGE_LENGTH_M = 40.0  # 50 scans of 200,000 points
LARGE = ("--beams", "128", "--azimuths", "1600", "--distortion")
LARGE_HZ = 20.0
PRIORITY = 10
BUSY_PER_CPU = 2
TILE_M = 20.0
ALONE, LOADED, REAL_TIME = "alone", "beside load", "beside load, in real time"
SWAPPED, SIZED, KILLED = "maps swapped", "200,000 points at 20 Hz", "killed once"


def measure(run: Run) -> list[Result]:
    """Return latencies of poses, and how many scans have none."""
    wanted = [name for name in _scenarios(Path()) if run.wants(f"{NAME}: {name}")]
    if not wanted:
        return []
    share = max(run.share, 0.2)
    found = []
    with tempfile.TemporaryDirectory() as directory:
        here = Path(directory)
        run.note(f"{NAME}: making drives up")
        drive = Drive.simulated(here / "drive", "--length", str(LENGTH_M * share))
        tiles = drive.tiles(TILE_M) if SWAPPED in wanted else here
        scenarios = _scenarios(tiles)
        large = None
        if SIZED in wanted:
            length = ("--length", str(LARGE_LENGTH_M * share))
            large = Drive.simulated(here / "large", *length, *LARGE)
        for name in wanted:
            run.note(f"{NAME}: {name}")
            played = large if name == SIZED and large is not None else drive
            found += results(name, scenarios[name].play(played, here))
    return found


def _scenarios(tiles: Path) -> dict[str, Scenario]:
    """Return what is played, by its name."""
    busy = BUSY_PER_CPU * len(os.sched_getaffinity(0))
    swapped = {
        "map_path": str(tiles),
        "dynamic_map_loading.map_radius": 100.0,
        "dynamic_map_loading.lidar_radius": 60.0,
        "dynamic_map_loading.update_distance": 10.0,
    }
    found = {ALONE: Scenario(), LOADED: Scenario(busy=busy)}
    if refusal(Scheduling("fifo", PRIORITY)) is None:
        found[REAL_TIME] = Scenario({"realtime_priority": PRIORITY}, busy)
    found[SWAPPED] = Scenario(swapped)
    found[SIZED] = Scenario({"sensor_points.deskew": True}, rate_hz=LARGE_HZ)
    found[KILLED] = Scenario(killed_after=15)
    return found


def results(name: str, rows: Sequence[dict[str, str]]) -> list[Result]:
    """Return what the rows of a replay's table say."""
    latencies = tuple(float(row["latency_ms"]) for row in rows if row["latency_ms"])
    lost = float(sum(row["state"] == "lost" for row in rows))
    found = [Result(LOST, name, "scans", (lost,))]
    if latencies:
        found.insert(0, Result(LATENCY, name, "ms", latencies))
    return found


def _goals() -> tuple[Goal, ...]:
    return (Goal(LOST, KILLED, "within", 10.0, statistic="largest"),)


QUESTION = Question(NAME, measure, _goals(), "the node's cores, as the mapfile has them")
