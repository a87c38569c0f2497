# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a matcher is asked: a scan and where it may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rmw_manycore_py.ndt.geometry.arrays import (
    Pose,
    ScanPoints,
    pose_error,
    pose_matrix,
    scan_points,
)
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.native_matcher import Position
from rmw_manycore_py.ndt.matching.options import MatcherOptions


@dataclass(frozen=True)
class Question:
    """A scan (N, 3), its guess (4, 4), and the position of the regularization pose.

    :param min_fit: fit up to which a result remains unfinished.
    """

    scan: ScanPoints
    guess: Pose
    position: Position | None
    min_fit: float = -np.inf


def question_of(
    points: ArrayLike,
    T_map_guess: ArrayLike,
    T_map_regularization: ArrayLike | None,
    options: MatcherOptions,
) -> Question | Alignment:
    """Return what to align, or the answer if that is not possible."""
    scan = scan_points(points)
    guess = pose_matrix(T_map_guess)
    wrong = pose_error(guess)
    if wrong:
        return Alignment.refused(None, f"the guess {wrong}", options)
    if T_map_regularization is None:
        return Question(scan, guess, None)
    regularization = pose_matrix(T_map_regularization)
    wrong = pose_error(regularization)
    if wrong:
        return Alignment.refused(guess, f"the regularization pose {wrong}", options)
    return Question(scan, guess, (float(regularization[0, 3]), float(regularization[1, 3])))
