# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Analysis of the steps of an alignment: gain of the score, and oscillation.

As in Autoware; with coarser maps, the initial score is that of the finest map's first step.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Poses
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics

OPPOSITE = -0.9  # cosine between two opposite steps
MANY_OSCILLATIONS = 10


def report_steps(alignment: Alignment, report: Diagnostics) -> None:
    """Add oscillation and initial scores."""
    oscillations = count_oscillations(alignment.path)
    report.value("local_optimal_solution_oscillation_num", oscillations)
    if oscillates(alignment.path):
        report.warn("There is a possibility of oscillation in a local minimum")
    scores = {
        "transform_probability": (
            alignment.first.transform_probability,
            alignment.transform_probability,
        ),
        "nearest_voxel_transformation_likelihood": (
            alignment.first.nearest_voxel_likelihood,
            alignment.nearest_voxel_likelihood,
        ),
    }
    for name, (before, after) in scores.items():
        report.value(f"{name}_diff", after - before)
        report.value(f"{name}_before", before)


def has_ended(alignment: Alignment) -> bool:
    """Return whether an alignment converged, or oscillates around a maximum."""
    return alignment.converged or (not alignment.is_degenerate and oscillates(alignment.path))


def oscillates(path: Poses) -> bool:
    """Return whether an alignment reversed more often in a row than a healthy one does."""
    return count_oscillations(path) > MANY_OSCILLATIONS


def count_oscillations(path: Poses) -> int:
    """Return the maximum number of consecutive steps that reversed the previous one."""
    most = count = 0
    steps = np.diff(path[:, :3, 3], axis=0)
    for before, step in pairwise(steps):
        lengths = float(np.linalg.norm(before) * np.linalg.norm(step))
        turned_back = lengths > 0.0 and float(before @ step) < OPPOSITE * lengths
        count = count + 1 if turned_back else 0
        most = max(most, count)
    return most
