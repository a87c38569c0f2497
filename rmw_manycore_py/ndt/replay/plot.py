# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plot of a replay: map and path, and errors, scores and latencies along the path.

Scans without a pose are red: crosses on the map, stripes along the path.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.replay.tally import Tally
from rmw_manycore_py.picture.plotting import load_figure

MAP_POINTS = 30_000
SCORES = {
    "nearest_voxel_transformation_likelihood": ("nearest voxels", "tab:blue"),
    "transform_probability": ("transform probability", "tab:green"),
}
GAP = "tab:red"
LEGEND_PT = 26  # height of a legend of one row


def plot(tally: Tally, map_points: Points | None, path: Path) -> None:
    """Write the plot; the suffix of the path selects its format."""
    figure = load_figure()(figsize=(17, 9), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1, 1.2))
    _draw_map(figure, figure.add_subplot(grid[:, 0]), tally, map_points)
    along_m = distances_m(tally)
    panels = [figure.add_subplot(grid[row, 1]) for row in range(3)]
    _draw_errors(panels[0], tally, along_m)
    _draw_scores(panels[1], tally, along_m)
    _draw_latencies(panels[2], tally, along_m)
    for panel in panels:
        _draw_gaps(panel, tally, along_m)
    panels[-1].set_xlabel("along the path [m]")
    figure.savefig(path, dpi=120)


def distances_m(tally: Tally) -> Matrix:
    """Return the distance (S,) travelled by the reference since the first scan."""
    places = np.array([row.reference[:3, 3] for row in tally.rows]).reshape(-1, 3)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    return np.concatenate([np.zeros(min(len(places), 1)), np.cumsum(steps)])


def _draw_map(figure: Any, axes: Any, tally: Tally, map_points: Points | None) -> None:
    if map_points is not None:
        shown = map_points[:: max(1, len(map_points) // MAP_POINTS)]
        axes.scatter(shown[:, 0], shown[:, 1], s=0.2, c="0.75", rasterized=True)
    reference = np.array([row.reference[:2, 3] for row in tally.rows])
    axes.plot(*reference.T, color="black", linewidth=1, label="reference")
    found = [
        (*row.result[:2, 3], row.error[0])
        for row in tally.rows
        if row.result is not None and row.error
    ]
    if found:
        x, y, error_m = np.array(found).T
        points = axes.scatter(x, y, c=error_m, s=8, cmap="viridis", label="ndt_pose", zorder=3)
        figure.colorbar(points, ax=axes, label="error [m]", shrink=0.6)
    lost = np.array([row.reference[:2, 3] for row in tally.rows if row.result is None])
    if len(lost):
        axes.plot(*lost.T, "x", color=GAP, label="no pose")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.set_title("map and path", pad=LEGEND_PT)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)


def _draw_errors(axes: Any, tally: Tally, along_m: Matrix) -> None:
    guesses = [error[0] if (error := row.guess_error) else np.nan for row in tally.rows]
    errors = np.array([row.error or (np.nan, np.nan) for row in tally.rows]).reshape(-1, 2)
    if np.isfinite(guesses).any():
        axes.plot(along_m, guesses, color="0.7", label="guess [m]")
    axes.plot(along_m, errors[:, 0], label="result [m]")
    axes.plot(along_m, errors[:, 1], label="result [degrees]")
    axes.set(title="error", yscale="log")
    _name_curves(axes)


def _draw_scores(axes: Any, tally: Tally, along_m: Matrix) -> None:
    for name, (label, color) in SCORES.items():
        axes.plot(along_m, _reported(tally, name), color=color, label=label)
        before = _reported(tally, f"{name}_before")
        axes.plot(along_m, before, ":", color=color, linewidth=1, label=f"{label}, before")
    axes.set(title="scores")
    _name_curves(axes)


def _draw_latencies(axes: Any, tally: Tally, along_m: Matrix) -> None:
    latencies = [np.nan if row.latency_ms is None else row.latency_ms for row in tally.rows]
    axes.plot(along_m, latencies, label="end to end")
    axes.plot(along_m, _reported(tally, "execution_time"), label="in the matcher")
    axes.axhline(tally.deadline_ms, color="0.5", linewidth=1, label="deadline")
    axes.set(title="latency", ylabel="ms", ylim=(0, None))
    _name_curves(axes)


def _name_curves(axes: Any) -> None:
    """Add the legend beside the panel, where it covers no curve."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _draw_gaps(axes: Any, tally: Tally, along_m: Matrix) -> None:
    """Mark scans without a pose, from the previous to the next scan."""
    last = len(along_m) - 1
    for index, row in enumerate(tally.rows):
        if row.result is None:
            start, end = along_m[max(index - 1, 0)], along_m[min(index + 1, last)]
            axes.axvspan(start, end, color=GAP, alpha=0.3, linewidth=0)


def _reported(tally: Tally, name: str) -> Matrix:
    return np.array([float(row.report.get(name, "nan")) for row in tally.rows])
