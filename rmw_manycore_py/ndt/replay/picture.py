# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""3D picture of a replay: the map, the path, and one matched scan."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.poses import transform
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.tally import Played, Tally
from rmw_manycore_py.picture.plotting import load_figure

MAP_POINTS, SCAN_POINTS = 40_000, 10_000
AROUND_M = 40.0  # width of the map shown beside the path
ELEVATION_DEG, AZIMUTH_DEG = 35.0, -120.0


def draw(tally: Tally, drive: Recording, map_points: Points | None, path: Path) -> None:
    """Write the picture, with the answered scan in the middle of the drive."""
    figure = load_figure()(figsize=(12, 9), layout="constrained")
    axes: Any = figure.add_subplot(projection="3d")
    places = np.array([row.reference[:3, 3] for row in tally.rows])
    if map_points is not None:
        _draw_map(axes, map_points, places)
    axes.plot(*places.T, color="black", linewidth=1, label="reference")
    answered = tally.answered()
    found = np.array([row.result[:3, 3] for row in answered if row.result is not None])
    if len(found):
        axes.plot(*found.T, "--", color="tab:orange", linewidth=1, label="ndt_pose")
        _draw_scan(axes, answered[len(answered) // 2], drive)
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", aspect="equal")
    axes.view_init(ELEVATION_DEG, AZIMUTH_DEG)
    axes.legend()
    figure.savefig(path, dpi=120)


def _draw_map(axes: Any, points: Points, places: Points) -> None:
    lower, upper = places.min(axis=0) - AROUND_M, places.max(axis=0) + AROUND_M
    near = points[((points > lower) & (points < upper)).all(axis=1)]
    shown = near[:: max(1, len(near) // MAP_POINTS)]
    axes.scatter(*shown.T, s=0.2, c=shown[:, 2], cmap="Greys_r", rasterized=True)


def _draw_scan(axes: Any, row: Played, drive: Recording) -> None:
    assert row.result is not None
    points = drive.scan(row.index)
    shown = transform(row.result, points[:: max(1, len(points) // SCAN_POINTS)].astype(np.float64))
    axes.scatter(*shown.T, s=0.5, color="tab:red", label=f"scan {row.index}", rasterized=True)
