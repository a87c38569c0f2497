# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The complete node behind the bridge: under load, with large scans, new maps, after a kill."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rmw_manycore_py.bench.ndt.driven import Scenario, SimulatedDrive
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.process.scheduling import Scheduling, refusal

NAME = "node"
LATENCY = "scan to pose, through the bridge"
LOST = "scans without a pose"
ERROR = "error of poses, whole node"
EXECUTION = "execution_time of the node"  # share of the end-to-end time spent in the node
CPU = "CPU time of node and workers, of each scan played"
LENGTH_M = 160.0  # 200 scans at 8 m/s
LARGE_LENGTH_M = 40.0  # 50 scans of 200,000 points
LARGE = ("--beams", "128", "--azimuths", "1600", "--distortion")
LARGE_HZ = 20.0
PRIORITY = 10
BUSY_PER_CPU = 2
TILE_M = 20.0
SWAP_FACTOR = 2.0  # runs differ by up to 2x; building a map inline costs 10x
ALONE, LOADED, REAL_TIME = "alone", "beside load", "beside load, in real time"
SWAPPED, SIZED, KILLED = "maps swapped", "200,000 points at 20 Hz", "killed once"


def measure(run: Run) -> list[Result]:
    """Return latencies of poses, and the number of scans without one."""
    wanted = [name for name in _scenarios(Path()) if run.wants(f"{NAME}: {name}")]
    if not wanted:
        return []
    share = max(run.share, 0.2)
    found = []
    with tempfile.TemporaryDirectory() as directory:
        here = Path(directory)
        run.note(f"{NAME}: making drives up")
        drive = SimulatedDrive.simulated(here / "drive", "--length", str(LENGTH_M * share))
        tiles = drive.tiles(TILE_M) if SWAPPED in wanted else here
        scenarios = _scenarios(tiles)
        large = None
        if SIZED in wanted:
            length = ("--length", str(LARGE_LENGTH_M * share))
            large = SimulatedDrive.simulated(here / "large", *length, *LARGE)
        for name in wanted:
            run.note(f"{NAME}: {name}")
            played = large if name == SIZED and large is not None else drive
            found += results(name, scenarios[name].play(played, here))
    return found


def _scenarios(tiles: Path) -> dict[str, Scenario]:
    """Return the scenarios by name."""
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
    found[SIZED] = Scenario({"sensor_points.deskew": True}, rate_hz=LARGE_HZ, voxel_m=0.0)
    found[KILLED] = Scenario(killed_after=15)
    return found


def results(name: str, rows: Sequence[dict[str, str]]) -> list[Result]:
    """Convert the rows of a replay's table to results."""
    latencies = tuple(float(row["latency_ms"]) for row in rows if row["latency_ms"])
    lost = float(sum(row["state"] == "lost" for row in rows))
    found = [Result(LOST, name, "scans", (lost,))]
    if latencies:
        found.insert(0, Result(LATENCY, name, "ms", latencies))
    errors_cm = tuple(100.0 * float(row["error_m"]) for row in rows if row.get("error_m"))
    if errors_cm:
        found.append(Result(ERROR, name, "cm", errors_cm))
    times_ms = tuple(float(row["execution_time"]) for row in rows if row.get("execution_time"))
    if times_ms:
        found.append(Result(EXECUTION, name, "ms", times_ms))
    return found + _cpu_time(name, rows)


def _cpu_time(name: str, rows: Sequence[dict[str, str]]) -> list[Result]:
    """Return the mean over a run; none if a killed node has begun to count anew."""
    known = [(i, float(row["cpu_time_s"])) for i, row in enumerate(rows) if row.get("cpu_time_s")]
    times_s = [time_s for _, time_s in known]
    if len(known) < 2 or times_s != sorted(times_s):
        return []
    (first, begin_s), (last, end_s) = known[0], known[-1]
    return [Result(CPU, name, "ms", (1e3 * (end_s - begin_s) / (last - first),))]


def _goals() -> tuple[Goal, ...]:
    return (
        Goal(LOST, KILLED, "within", 10.0, statistic="largest"),
        Goal(LOST, SIZED, "within", 0.0, statistic="largest"),
        Goal(LOST, SWAPPED, "within", 0.0, statistic="largest"),
        *(
            Goal(question, SWAPPED, "within", SWAP_FACTOR, ALONE, statistic="p99")
            for question in (LATENCY, EXECUTION)
        ),
    )


QUESTION = Question(NAME, measure, _goals(), "the node's cores, as the mapfile has them")
