# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Writes a replay as CSV, one row per scan."""

from __future__ import annotations

import csv
from pathlib import Path

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.replay.tally import Played, Tally

AXES = ("x", "y", "z", "roll", "pitch", "yaw")
UPPER = [(i, j) for i in range(6) for j in range(i, 6)]  # a covariance is symmetric
# Values of the matcher's diagnostics, by their keys.
REPORTED = (
    "transform_probability",
    "transform_probability_before",
    "nearest_voxel_transformation_likelihood",
    "nearest_voxel_transformation_likelihood_before",
    "iteration_num",
    "local_optimal_solution_oscillation_num",
    "execution_time",
    "initial_pose_age",
    "second_looks",
    "cpu_time_s",
    "sensor_points_size",
    "sensor_points_matched",
    "decode_time_ms",
    "deskew_time_ms",
    "map_time_ms",
    "match_time_ms",
    "publish_time_ms",
)
COLUMNS = (
    *("scan", "stamp_s", "state", "reason"),
    *("x", "y", "z", "qx", "qy", "qz", "qw"),
    *("guess_error_m", "guess_error_deg", "error_m", "error_deg", "latency_ms"),
    *REPORTED,
    *(f"cov_{AXES[i]}_{AXES[j]}" for i, j in UPPER),
)


def write_csv(tally: Tally, path: Path) -> None:
    """Write the scans; cells without a value are empty.

    `state` is answered, late or lost; `reason` is the message of the matcher's diagnostics. Poses
    and covariances are in the map frame (m, rad), stamps those of the recording, `execution_time`
    in ms.
    """
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for row in tally.rows:
            writer.writerow(_cells(row, tally))


def _cells(row: Played, tally: Tally) -> list[object]:
    pose: list[object] = [""] * 7
    if row.result is not None:
        pose = [*row.result[:3, 3], *poses.to_quaternion(row.result[:3, :3])]
    covariance: list[object] = [""] * len(UPPER)
    if row.covariance is not None:
        covariance = [row.covariance[i, j] for i, j in UPPER]
    reason = "" if row.reason == "OK" else row.reason
    errors = [*(row.guess_error or ("", "")), *(row.error or ("", ""))]
    reported = [row.report.get(name, "") for name in REPORTED]
    state = tally.state(row)
    head = [row.index, row.stamp_s, state, reason]
    return [*head, *pose, *errors, row.latency_ms, *reported, *covariance]
