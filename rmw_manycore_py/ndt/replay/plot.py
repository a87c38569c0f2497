# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A picture of a replay: map and path from above, error and latency over the scans."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rmw_manycore_py.figures import load_figure
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.replay.tally import Tally

MAP_POINTS = 30_000


def plot(tally: Tally, map_points: Points | None, path: Path) -> None:
    """Write the picture; the suffix of the path chooses its format."""
    figure = load_figure()(figsize=(15, 5), layout="constrained")
    axes = figure.subplots(1, 3)
    if map_points is not None:
        shown = map_points[:: max(1, len(map_points) // MAP_POINTS)]
        axes[0].scatter(shown[:, 0], shown[:, 1], s=0.2, c="0.75", rasterized=True)
    reference = np.array([row.reference[:2, 3] for row in tally.rows])
    answered = tally.answered()
    found = np.array([row.result[:2, 3] for row in answered if row.result is not None])
    axes[0].plot(*reference.T, color="black", linewidth=1, label="reference")
    if len(found):
        axes[0].plot(*found.T, "--", color="tab:red", linewidth=1, label="ndt_pose")
    axes[0].set(xlabel="x [m]", ylabel="y [m]", title="map and path", aspect="equal")
    axes[0].legend()

    indices = [row.index for row in answered]
    errors = np.array([row.error for row in answered]).reshape(-1, 2)
    guesses = [(row.index, row.guess_error[0]) for row in tally.rows if row.guess_error]
    if guesses:
        axes[1].plot(*np.array(guesses).T, color="0.7", label="guess [m]")
    axes[1].plot(indices, errors[:, 0], label="result [m]")
    axes[1].plot(indices, errors[:, 1], label="result [degrees]")
    axes[1].set(xlabel="scan", yscale="log", title="error")
    axes[1].legend()

    axes[2].plot(indices, [row.latency_ms for row in answered])
    axes[2].axhline(tally.deadline_ms, color="tab:red", linewidth=1)
    axes[2].set(xlabel="scan", ylabel="ms", title="end to end", ylim=0)
    figure.savefig(path, dpi=120)
