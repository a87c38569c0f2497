# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The wheelchair of ROS-lite2's case study: off-loaded, on plain Fast DDS, and with faults.

Each drive is a separate `manycore whill drive` over the whole course.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rmw_manycore_hook import plain_environment
from rmw_manycore_program import own_program
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError

OFF_LOADED, PLAIN = "off-loaded", "plain Fast DDS"
OPTIONS = {OFF_LOADED: "--run", PLAIN: "--plain"}
FAULT_S = 15.0  # after the start, on the first straight
KILLED = (
    *("pointcloud_map_loader", "ndt_scan_matcher", "ekf_localizer", "simple_trajectory_follower"),
    *("vehicle_cmd_gate", "static_trajectory_publisher", "pose_initializer_node"),
    *("whill_interface", "vehicle_velocity_converter_node", "gyro_odometer"),
    *("bridge inward", "bridge outward"),
)
# Without these, no command or none based on a current pose reaches the wheelchair.
CONTROL_CHAIN = (
    *("ekf_localizer", "simple_trajectory_follower", "vehicle_cmd_gate", "whill_interface"),
    *("bridge inward", "bridge outward"),
)
STOPPED = "stop:ndt_scan_matcher"
TIMEOUT_S = 900.0
STOOD_S = 0.5 + 0.1  # timeout plus one period of the gate's timer, the slowest


def drive_question(course: Path, namespace: str | None = None) -> Question:
    """Return the question comparing off-loaded nodes with the same nodes on the laptop.

    :param namespace: network namespace of the nodes; counts its packets.
    """
    place = () if namespace is None else ("--netns", namespace)
    contenders = (OFF_LOADED, PLAIN)
    goals = (
        Goal("finished", OFF_LOADED, "better", 1.0, statistic="mean"),
        Goal("lateral error, RMS", OFF_LOADED, "within", 0.10),
        Goal("lateral error, largest", OFF_LOADED, "within", 0.30),
        Goal("scan to command", OFF_LOADED, "within", 100.0, statistic="p99"),
        Goal("scans lost or late", OFF_LOADED, "within", 0.0, statistic="largest"),
        Goal("command period", OFF_LOADED, "within", 40.0, statistic="p99"),
        Goal("CPU of the bridge", OFF_LOADED, "within", 15.0),
    )

    def measure(run: Run) -> list[Result]:
        found = {
            name: [_driven(run, course, OPTIONS[name], *place) for _ in range(run.rounds)]
            for name in contenders
            if run.wants(f"drive: {name}")
        }
        return [
            Result(question, name, unit, tuple(samples), question in HIGHER_IS_BETTER)
            for question, (unit, samples_of) in FIGURES.items()
            for name, drives in found.items()
            if (samples := [value for drive in drives for value in samples_of(drive)])
        ]

    return Question("drive", measure, goals, f"{course}: one drive after the other")


def fault_question(course: Path) -> Question:
    """Return the question how soon the vehicle stops after a fault, and whether it continues."""
    goals = [
        *(
            Goal("told to stand after", f"kill -9 {name}", "within", STOOD_S)
            for name in CONTROL_CHAIN
        ),
        *(
            Goal("finished", contender, "better", 1.0, statistic="mean")
            for contender in (*(f"kill -9 {name}" for name in KILLED), STOPPED)
        ),
    ]

    def measure(run: Run) -> list[Result]:
        faults = {f"kill -9 {name}": name for name in KILLED} | {STOPPED: STOPPED}
        results: list[Result] = []
        for contender, target in faults.items():
            if run.wants(f"faults: {contender}"):
                results += _disturbed(run, course, contender, target)
        return results

    return Question("faults", measure, tuple(goals), f"each {FAULT_S:g} s after the start")


def _disturbed(run: Run, course: Path, contender: str, target: str) -> list[Result]:
    drives = [
        _driven(run, course, "--run", "--fault", f"{target}@{FAULT_S}") for _ in range(run.rounds)
    ]
    outcomes = [drive["faults"][0] for drive in drives if drive["faults"]]
    columns = {
        "told to stand after": ("s", [o["stood_s"] for o in outcomes if o["stood_s"] is not None]),
        "drives on after": (
            "s",
            [o["drove_on_s"] for o in outcomes if o["drove_on_s"] is not None],
        ),
        "named as gone": ("of 1", [float(bool(o["named_by"])) for o in outcomes]),
        "finished": ("of 1", [float(drive["is_finished"]) for drive in drives]),
    }
    return [
        Result(question, contender, unit, tuple(samples), question in HIGHER_IS_BETTER)
        for question, (unit, samples) in columns.items()
        if samples
    ]


def _driven(run: Run, course: Path, *options: str) -> dict[str, Any]:
    """Return the summary of a drive, also of one that did not reach the end."""
    run.note(f"driving: {' '.join(options)}")
    command = own_program(
        "rmw_manycore_py.cli", "whill", "drive", "--course", str(course), "--json", *options
    )
    environment = plain_environment({**os.environ, "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, "")
    drive = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
    )
    try:
        figures: dict[str, Any] = json.loads(drive.stdout)
    except ValueError as error:
        raise ManycoreError(f"no figures of a drive: {drive.stderr.strip()[-500:]}") from error
    return figures


def _one(name: str) -> Callable[[Mapping[str, Any]], list[float]]:
    def values(drive: Mapping[str, Any]) -> list[float]:
        return [] if drive[name] is None else [float(drive[name])]

    return values


def _missed(drive: Mapping[str, Any]) -> list[float]:
    return [float(drive["scans_lost"] + drive["scans_late"])]


HIGHER_IS_BETTER = ("finished", "named as gone")
FIGURES: dict[str, tuple[str, Callable[[Mapping[str, Any]], list[float]]]] = {
    "finished": ("of 1", _one("is_finished")),
    "lateral error, RMS": ("m", _one("lateral_m_rms")),
    "lateral error, largest": ("m", _one("lateral_m_max")),
    "scan to command": ("ms", lambda drive: list(drive["latencies_ms"])),
    "scans lost or late": ("", _missed),
    "command period": ("ms", lambda drive: list(drive["periods_ms"])),
    "CPU of the bridge": ("%", _one("bridge_cpu_percent")),
    "CPU of the off-loaded nodes": ("%", _one("platform_cpu_percent")),
    "CPU of the rest of the laptop": ("s", _one("laptop_cpu_s")),
    "packets to the nodes": ("", _one("packets_in")),
}
