# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a matcher answers."""

from __future__ import annotations

from dataclasses import dataclass

from rmw_manycore_py.ndt.geometry.arrays import Matrix6, Pose


@dataclass(frozen=True)
class Score:
    """How well a scan fits at a pose, with the words of PCL and Autoware.

    :param score: sum over points and the voxels they see (Magnusson, eq. 6.9); higher is better.
    :param transform_probability: score per finite point of the scan.
    :param nearest_voxel_likelihood: mean over the points that see a voxel of their best voxel's
        score.
    :param points_in_map: points that see a voxel.
    """

    score: float
    transform_probability: float
    nearest_voxel_likelihood: float
    points_in_map: int


@dataclass(frozen=True)
class Alignment:
    """Where a scan fits best.

    :param T_map_sensor: (4, 4) pose reached; always finite, the guess when nothing could be done,
        the identity when the guess was no pose either.
    :param covariance: (6, 6) of x, y, z [m], roll, pitch, yaw [rad].
    :param iterations: steps taken.
    :param converged: False when the pose must not be used; ``why`` then says so.
    :param guesses_around: (4, 4) poses around the result that its covariance was made of, if any.
    :param results_around: (4, 4) what alignments from them reached, if there were such.
    """

    T_map_sensor: Pose
    covariance: Matrix6
    iterations: int
    score: float
    transform_probability: float
    nearest_voxel_likelihood: float
    converged: bool
    why: str
    guesses_around: tuple[Pose, ...] = ()
    results_around: tuple[Pose, ...] = ()
