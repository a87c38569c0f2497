# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plays a simulated drive to the complete node with `manycore run` and `ndt replay`."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from rmw_manycore_hook import plain_environment
from rmw_manycore_program import own_program
from rmw_manycore_py.bench.load import busy
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.parent_death import dies_with_this_process

NODE = "ndt_scan_matcher"
TOPIC_IN = {
    "pointcloud_map": "sensor_msgs/msg/PointCloud2",
    "points_raw": "sensor_msgs/msg/PointCloud2",
    "ekf_pose_with_covariance": "geometry_msgs/msg/PoseWithCovarianceStamped",
}
TOPIC_TO = {
    "ndt_pose": "geometry_msgs/msg/PoseStamped",
    "ndt_pose_with_covariance": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
}
DOMAIN = 90  # benches run one at a time
END_S = 60.0  # timeout for stopping a run
TIMEOUT_S = 600.0  # timeout of one program; a drive takes 20 s


@dataclass(frozen=True)
class SimulatedDrive:
    """Files written by `manycore ndt simulate`."""

    directory: Path

    @classmethod
    def simulated(cls, directory: Path, *options: str) -> SimulatedDrive:
        """Simulate a drive."""
        _call("ndt", "simulate", str(directory), *options)
        return cls(directory)

    def tiles(self, size_m: float) -> Path:
        """Write the map as tiles; return their directory."""
        tiles = self.directory / "tiles"
        drive = str(self.directory / "drive.npz")
        size = ("--tile-size", str(size_m), "--format", "npz")
        _call("ndt", "map", drive, "-o", str(tiles), *size)
        return tiles


@dataclass(frozen=True)
class Scenario:
    """How a drive is played.

    :param parameters: of the node, in addition to `activated`.
    :param busy: number of processes that keep CPUs busy.
    :param rate_hz: rate of the scans; None uses the stamps of the drive.
    :param voxel_m: voxel size to which the laptop thins scans; 0 sends them as they are.
    :param killed_after: number of answered scans after which the node is killed; 0 means never.
    """

    parameters: dict[str, Any] = field(default_factory=dict)
    busy: int = 0
    rate_hz: float | None = None
    voxel_m: float = 0.5
    killed_after: int = 0

    def play(self, drive: SimulatedDrive, directory: Path) -> list[dict[str, str]]:
        """Return the rows of the replay's table."""
        cpus = sorted(os.sched_getaffinity(0))
        with busy(self.busy, cpus, TIMEOUT_S), self._running(directory) as pid_of_node:
            rows = directory / "scans.csv"
            pace = () if self.rate_hz is None else ("--rate", str(self.rate_hz))
            source = ("--no-map",) if "map_path" in self.parameters else ()
            words = ("--csv", str(rows), "--motion", "reference", *pace, *source)
            words += ("--voxel", str(self.voxel_m))
            replay = _started("ndt", "replay", str(drive.directory / "drive.npz"), *words)
            with _time_limit(replay):
                if self.killed_after:
                    _wait_until_answered(replay, self.killed_after)
                    os.kill(pid_of_node, signal.SIGKILL)
                output, _ = replay.communicate()
        if replay.returncode < 0 or not rows.exists():
            raise ManycoreError(f"the replay failed{_how_it_ended(replay)}: {output}")
        with rows.open() as file:
            return list(csv.DictReader(file))

    @contextmanager
    def _running(self, directory: Path) -> Iterator[int]:
        """Run the node; yield its process id."""
        path = directory / "map.yaml"
        path.write_text(json.dumps(self.mapfile(directory)))
        run = _started("run", str(path), "--json")
        try:
            with _time_limit(run):
                pid = _pid_of_node(run)
            yield pid
        finally:
            run.send_signal(signal.SIGINT)
            try:
                run.wait(END_S)
            except subprocess.TimeoutExpired:
                run.kill()
                run.wait()

    def mapfile(self, directory: Path) -> dict[str, Any]:
        """Return the mapfile of the run; its node writes to `directory`."""
        node = {
            "module": f"rmw_manycore_py.ndt.nodes.{NODE}",
            "cluster": 3,
            "core": 1,
            "wait": "adaptive",
            "workers": 12,
            "respawn": {"delay": 0},
            "topic_in": TOPIC_IN,
            "topic_to": TOPIC_TO,
            "parameters": {
                "activated": True,
                "last_pose_path": str(directory / "last_pose"),
                **self.parameters,
            },
        }
        return {
            "platform": {"profile": "coolidge", "smem_size": "128MiB"},
            "nodes": {NODE: node},
        }


def _call(*words: str) -> None:
    process = _started(*words)
    with _time_limit(process):
        output, _ = process.communicate()
    if process.returncode != 0:
        how = _how_it_ended(process)
        raise ManycoreError(f"manycore {' '.join(words)} failed{how}: {output}")


@contextmanager
def _time_limit(process: subprocess.Popen[str]) -> Iterator[None]:
    """Kill a process that exceeds the timeout, which ends its output."""
    timer = threading.Timer(TIMEOUT_S, process.kill)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _how_it_ended(process: subprocess.Popen[str]) -> str:
    is_killed = process.returncode == -signal.SIGKILL
    return f" (not done within {TIMEOUT_S:g} s, or killed)" if is_killed else ""


def _started(*words: str) -> subprocess.Popen[str]:
    environment = plain_environment(os.environ, sys.prefix)
    environment.update(ROS_DOMAIN_ID=str(DOMAIN), MANYCORE_PLATFORM=f"bench-{os.getpid()}")
    return subprocess.Popen(
        own_program("rmw_manycore_py.cli", *words),
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        preexec_fn=dies_with_this_process(),
    )


def _pid_of_node(run: subprocess.Popen[str]) -> int:
    """Wait for the start of the node; keep draining the run's output afterwards."""
    said = []
    for line in _lines(run):
        said.append(line)
        event = json.loads(line) if line.startswith("{") else {}
        if event.get("event") == "started" and event.get("node") == NODE:
            # Drain the pipe, so that the run never blocks on it.
            threading.Thread(target=_lines(run).read, daemon=True).start()
            return int(event["pid"])
    raise ManycoreError(f"{NODE} did not start within {TIMEOUT_S:g} s: {''.join(said)}")


def _wait_until_answered(replay: subprocess.Popen[str], scans: int) -> None:
    """Wait for a progress line that reports this many answered scans."""
    for line in _lines(replay):
        words = line.split()
        if words[:1] == ["scan"] and int(words[1]) >= scans:
            return


def _lines(process: subprocess.Popen[str]) -> IO[str]:
    assert process.stdout is not None
    return process.stdout
