# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plot of a drive: course and driven path; error, speed and latency over time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.papers.roslite2.course.directory import Course
from rmw_manycore_py.papers.roslite2.laptop.drive_log import DEADLINE_S, DriveLog
from rmw_manycore_py.picture.plotting import load_figure

MAP_POINTS = 30_000
INCIDENT = "tab:red"


def plot(log: DriveLog, course: Course, path: Path) -> None:
    """Write the plot; the suffix of the path selects its format."""
    figure = load_figure()(figsize=(15, 9), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1, 1.2))
    _draw_way(figure.add_subplot(grid[:, 0]), log, course)
    panels = [figure.add_subplot(grid[row, 1]) for row in range(3)]
    start_s = log.start_s() or (log.moments[0].time_s if log.moments else 0.0)
    _draw_errors(panels[0], log, start_s)
    _draw_speeds(panels[1], log, start_s)
    _draw_latencies(panels[2], log, start_s)
    for panel in panels:
        for incident in log.incidents:
            panel.axvline(incident.time_s - start_s, color=INCIDENT, linewidth=0.7, alpha=0.6)
    panels[-1].set_xlabel("time [s]")
    figure.savefig(path, dpi=120)


def _draw_way(axes: Any, log: DriveLog, course: Course) -> None:
    points = course.map_points[:: max(1, len(course.map_points) // MAP_POINTS)]
    axes.scatter(points[:, 0], points[:, 1], s=0.2, c="0.75", rasterized=True)
    axes.plot(course.trajectory.x_m, course.trajectory.y_m, color="black", label="trajectory")
    axes.plot([m.x_m for m in log.moments], [m.y_m for m in log.moments], label="driven")
    axes.set(xlabel="x [m]", ylabel="y [m]", title="course", aspect="equal")
    axes.legend()


def _draw_errors(axes: Any, log: DriveLog, start_s: float) -> None:
    times = [moment.time_s - start_s for moment in log.moments]
    axes.plot(times, [moment.lateral_m for moment in log.moments])
    axes.set(title="lateral error", ylabel="m")


def _draw_speeds(axes: Any, log: DriveLog, start_s: float) -> None:
    commands = log.commands
    times = [command.time_s - start_s for command in commands]
    axes.plot(times, [command.speed_m_s for command in commands], label="cmd_vel", color="0.6")
    driven = log.moments
    axes.plot([m.time_s - start_s for m in driven], [m.speed_m_s for m in driven], label="driven")
    axes.set(title="speed", ylabel="m/s")
    axes.legend(loc="lower right")


def _draw_latencies(axes: Any, log: DriveLog, start_s: float) -> None:
    scans = list(log.scans.values())
    times = np.array([scan.stamp_s - start_s for scan in scans])
    latencies = [np.nan if (s := scan.latency_s) is None else 1e3 * s for scan in scans]
    axes.plot(times, latencies, ".", markersize=3)
    axes.axhline(1e3 * DEADLINE_S, color="0.5", linewidth=1)
    axes.set(title="scan to the command that used it", ylabel="ms", ylim=(0, None))
