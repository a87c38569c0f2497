# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""3D picture of a replay: the map by height, scans where they were found, the path by error."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.poses import transform
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.tally import Played, Tally
from rmw_manycore_py.picture.plotting import load_figure

MAP_POINTS, SCAN_POINTS, SCANS = 80_000, 4_000, 3
ZOOM = 1.7  # fills the figure; by default most of it is empty
AROUND_M = 40.0  # width of the map shown beside the path
PATH_ABOVE_M = 1.0  # the path is drawn above the ground that it runs on
ELEVATION_DEG = 38.0
HIGHEST = 0.98  # share of the map's points whose heights get a colour of their own
BACKGROUND, FOREGROUND, SCAN = "#10141c", "0.85", "#ff5a4f"


def draw(tally: Tally, drive: Recording, map_points: Points | None, path: Path) -> None:
    """Write the picture, with some answered scans along the drive."""
    figure = load_figure()(figsize=(13, 8), layout="constrained", facecolor=BACKGROUND)
    axes: Any = figure.add_subplot(projection="3d", facecolor=BACKGROUND, computed_zorder=False)
    places = np.array([row.reference[:3, 3] for row in tally.rows])
    if map_points is not None:
        _draw_map(axes, map_points, places)
    answered = tally.answered()
    _draw_scans(axes, answered[:: max(1, -(-len(answered) // SCANS))], drive)
    above = places + np.array([0.0, 0.0, PATH_ABOVE_M])
    axes.plot(*above.T, color=FOREGROUND, linewidth=1, label="reference", zorder=3)
    if answered:
        _draw_path(figure, axes, answered)
    axes.set_box_aspect([upper - lower for lower, upper in _limits(axes)], zoom=ZOOM)
    axes.set_axis_off()
    axes.view_init(ELEVATION_DEG, _across(places))
    axes.legend(loc="upper left", frameon=False, labelcolor=FOREGROUND, markerscale=4)
    figure.savefig(path, dpi=150, bbox_inches="tight", facecolor=BACKGROUND)


def _draw_map(axes: Any, points: Points, places: Matrix) -> None:
    lower, upper = places.min(axis=0) - AROUND_M, places.max(axis=0) + AROUND_M
    near = points[((points > lower) & (points < upper)).all(axis=1)]
    shown = near[:: max(1, len(near) // MAP_POINTS)]
    lowest, highest = np.quantile(shown[:, 2], (1.0 - HIGHEST, HIGHEST)) if len(shown) else (0, 1)
    heights = {"c": shown[:, 2], "cmap": "viridis", "vmin": lowest, "vmax": highest}
    axes.scatter(*shown.T, s=0.4, linewidths=0, depthshade=False, rasterized=True, **heights)


def _draw_scans(axes: Any, rows: list[Played], drive: Recording) -> None:
    style = {"s": 0.6, "linewidths": 0, "depthshade": False, "rasterized": True, "zorder": 2}
    for row in rows:
        points = drive.scan(row.index)
        points = points[:: max(1, len(points) // SCAN_POINTS)].astype(np.float64)
        assert row.result is not None
        shown = transform(row.result, points)
        label = "scans, where found" if row is rows[0] else None
        axes.scatter(*shown.T, color=SCAN, alpha=0.6, label=label, **style)


def _limits(axes: Any) -> tuple[Any, Any, Any]:
    return axes.get_xlim(), axes.get_ylim(), axes.get_zlim()


def _draw_path(figure: Any, axes: Any, answered: list[Played]) -> None:
    """Draw the poses that were found, coloured by their error."""
    found = [
        (row.result[:3, 3], row.error[0])
        for row in answered
        if row.result is not None and row.error
    ]
    places = np.array([place for place, _ in found]) + np.array([0.0, 0.0, PATH_ABOVE_M])
    errors = [error_m for _, error_m in found]
    style = {"s": 14, "linewidths": 0, "depthshade": False, "zorder": 4, "label": "ndt_pose"}
    points = axes.scatter(*places.T, c=errors, cmap="plasma", vmin=0.0, **style)
    bar = figure.colorbar(points, ax=axes, shrink=0.5, pad=0.02)
    bar.set_label("error [m]", color=FOREGROUND)
    bar.ax.tick_params(colors=FOREGROUND)
    bar.outline.set_visible(False)


def _across(places: Matrix) -> float:
    """Return the azimuth in degrees of a view across the path, so that its whole length is seen."""
    _, vectors = np.linalg.eigh(np.cov(places[:, :2].T) if len(places) > 1 else np.eye(2))
    ahead = vectors[:, 1]
    return float(np.degrees(np.arctan2(ahead[1], ahead[0]))) - 70.0
