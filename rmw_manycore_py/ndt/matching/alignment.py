# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Results of a matcher."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.enums import Outcome
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Matrix6, Pose, Poses
from rmw_manycore_py.ndt.matching.options import MatcherOptions

WHY: dict[Outcome, str] = {
    "converged": "",
    "iteration_limit": "still moving after max_iterations steps",
    "no_overlap": "no point of the scan lies in the map: wrong guess or wrong map",
    "degenerate": "the scan does not constrain the pose: too few points, or too far from the map",
    "surpassed": "another guess led to a better place",
    "unfinished": "",
}


@dataclass(frozen=True)
class Score:
    """How well a scan fits at a pose, in terms of PCL and Autoware.

    :param score: sum over points and voxels in their neighbourhood (Magnusson, eq. 6.9); higher is
        better.
    :param transform_probability: score per finite point of the scan.
    :param nearest_voxel_likelihood: score of the best voxel, averaged over the points that have
        voxels in their neighbourhood.
    :param points_in_map: number of points with voxels in their neighbourhood.
    """

    score: float
    transform_probability: float
    nearest_voxel_likelihood: float
    points_in_map: int

    @classmethod
    def of(cls, found: _ndt.Derivatives) -> Score:
        """Return the score computed by the kernel."""
        seen, points = found.points, found.scan_points
        return cls(
            score=found.score,
            transform_probability=found.score / points if points else 0.0,
            nearest_voxel_likelihood=found.nearest / seen if seen else 0.0,
            points_in_map=int(seen),
        )


@dataclass(frozen=True)
class Alignment:
    """Result of an alignment.

    :param T_map_sensor: (4, 4) final pose; always finite: the guess if alignment was impossible,
        the identity if the guess was invalid.
    :param covariance: (6, 6) of x, y, z [m], roll, pitch, yaw [rad].
    :param iterations: number of steps, on all maps.
    :param converged: False if the alignment hit the iteration limit or ended away from a maximum;
        ``why`` names which. True does not imply that the pose is right: see ``ndt.trust``.
    :param share_in_map: fraction of finite points with voxels in their neighbourhood, 0 to 1.
    :param is_degenerate: the score has no maximum at the pose, so the pose is meaningless.
    :param xy_spread_m2: (2, 2) covariance of x and y from the curvature of the score, times the
        number of points: large along a tunnel, for any scan size.
    :param raised_spread_m2: the same from what stands above the ground alone, if the other is
        doubtful; None if not computed.
    :param first: score at the start of the steps on the finest map; without coarser maps, the score
        of the guess.
    :param path: (n, 4, 4) the guess and the pose after each step, on all maps; at most 64 of
        each alignment that led to the result.
    :param explained_score: score of what the map can contradict (evidence.py); 0 if not computed.
    :param looks: number of alignments that this one is the best of.
    :param is_refused: whether nothing was aligned.
    :param is_unfinished: whether only few points were aligned, as they fit too little; the matcher
        finishes what it returns.
    :param guesses_around: (4, 4) poses around the result used for its covariance, if any.
    :param results_around: (4, 4) results of alignments from those poses, if any.
    """

    T_map_sensor: Pose
    covariance: Matrix6
    iterations: int
    score: float
    transform_probability: float
    nearest_voxel_likelihood: float
    converged: bool
    why: str
    first: Score
    path: Poses
    share_in_map: float = 0.0
    is_degenerate: bool = False
    xy_spread_m2: Matrix = field(default_factory=lambda: np.zeros((2, 2)))
    raised_spread_m2: Matrix | None = None
    explained_score: float = 0.0
    looks: int = 1
    is_refused: bool = False
    is_unfinished: bool = False
    guesses_around: tuple[Pose, ...] = ()
    results_around: tuple[Pose, ...] = ()

    @classmethod
    def of(cls, found: _ndt.NewtonResult, options: MatcherOptions) -> Alignment:
        """Return the alignment computed by the kernel.

        A pose at which the score does not decrease in all directions is degenerate: a scan of few
        points has no maximum.
        """
        score = Score.of(found.at)
        by_curvature = found.at.covariance
        is_maximum = by_curvature is not None
        ended = found.outcome
        is_end = ended in ("converged", "unfinished")
        outcome = "degenerate" if is_end and not is_maximum else ended
        covariance: Matrix6 = np.diag(options.fixed_pose_variances)
        if by_curvature is None:
            by_curvature = np.zeros((6, 6))
        elif options.pose_covariance == "laplace":
            covariance = by_curvature
        return cls(
            T_map_sensor=found.pose,
            covariance=covariance,
            iterations=found.iterations,
            score=score.score,
            transform_probability=score.transform_probability,
            nearest_voxel_likelihood=score.nearest_voxel_likelihood,
            converged=is_end and is_maximum,
            why=WHY[outcome],
            first=Score.of(found.first),
            path=found.path,
            share_in_map=score.points_in_map / max(found.at.scan_points, 1),
            is_degenerate=not is_maximum or ended in ("no_overlap", "surpassed"),
            is_unfinished=ended == "unfinished",
            xy_spread_m2=by_curvature[:2, :2] * found.at.scan_points,
        )

    @property
    def fit(self) -> float:
        """Return the likelihood, reduced for points outside the map; for comparing places."""
        return self.nearest_voxel_likelihood * self.share_in_map

    @property
    def known_fit(self) -> float:
        """Return how well a result fits, by what the map can contradict where that is known."""
        return 0.0 if self.is_degenerate else max(self.fit, self.explained_score)

    def scored(self, score: Score, points: int) -> Alignment:
        """Return this alignment with the score of more points than it was found with."""
        return replace(
            self,
            score=score.score,
            transform_probability=score.transform_probability,
            nearest_voxel_likelihood=score.nearest_voxel_likelihood,
            share_in_map=score.points_in_map / max(points, 1),
        )

    def continued_from(self, start: Alignment) -> Alignment:
        """Return this alignment with the steps of the one whose result it began at."""
        path = np.concatenate([start.path, self.path[1:]])
        return replace(self, iterations=start.iterations + self.iterations, path=path)

    @classmethod
    def refused(cls, guess: Pose | None, why: str, options: MatcherOptions) -> Alignment:
        """Return the result for input that cannot be aligned."""
        pose = np.eye(4) if guess is None else guess.copy()
        return cls(
            T_map_sensor=pose,
            covariance=np.diag(options.fixed_pose_variances),
            iterations=0,
            score=0.0,
            transform_probability=0.0,
            nearest_voxel_likelihood=0.0,
            converged=False,
            why=why,
            first=Score(0.0, 0.0, 0.0, 0),
            path=pose[None],
            is_degenerate=True,
            is_refused=True,
        )
