# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options of maps and matching."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Literal, get_args, get_type_hints

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native.enums import Search, StepRule, VoxelCovariance

PoseCovariance = Literal["laplace", "fixed", "multi_ndt", "multi_ndt_score"]
Offsets = tuple[tuple[float, float], ...]
MAX_LEVELS = 6  # of all kinds; limit of the kernel


@dataclass(frozen=True)
class MatcherOptions:
    """Options of map and matcher; the defaults are Autoware's where it has them.

    Exceptions are ``coarse_levels``, ``wide_levels`` and ``voxel_covariance``, which enlarge the
    basin of convergence, and ``polish_levels``, which make poses more accurate
    (docs/design/ndt.md).

    :param voxel_size_m: edge of a voxel; "resolution" in Autoware and PCL.
    :param coarse_levels: maps a scan is aligned to first, as multiples of the voxel size in
        decreasing order; empty uses ``voxel_size_m`` only, as PCL and Autoware do.
    :param wide_levels: maps that precede them in a second look (second_look.py), as multiples of
        the voxel size; only those coarser than all of ``coarse_levels`` count. Without any, or
        without coarse levels, no second look is taken.
    :param polish_levels: maps that only refine the pose found, as multiples of the voxel size in
        decreasing order; none without coarse levels or with regularization, whose weight is meant
        for the score of ``voxel_size_m``. Scores and covariances of poses remain those of
        ``voxel_size_m``.
    :param search: voxel neighbourhood of a point. ``radius``: voxels whose mean is within one voxel
        size (PCL, Autoware); ``direct7``: its own and those across the six faces; ``direct1``: its
        own.
    :param voxel_covariance: covariance of a voxel from the scatter S of its n points. ``pcl``:
        S / (n - 1); ``autoware``: (I + S) / (n - 1); ``pclomp``: (I + S) (n - 1) / n^2. The
        identity, 1 m^2, widens voxels of few points.
    :param min_points_per_voxel: voxels with fewer points are dropped; at least 3.
    :param step_rule: ``trust_region``: follows the gradient also where the score is not concave,
        with a radius adapted to the success of earlier steps (ours; docs/design/ndt.md);
        ``clamped``: Newton's step, limited to ``step_size`` (Autoware's default);
        ``more_thuente``: line search up to ``step_size`` (PCL).
    :param step_size: maximum step of the latter two, in metres and radians together.
    :param trans_epsilon: a shorter step ends the alignment.
    :param max_iterations: maximum number of steps; then the alignment has not converged.
    :param outlier_ratio: expected share of points that match nothing in the map.
    :param regularization_scale_factor: weight of the regularization pose, along the vehicle's axis;
        0 disables it.
    :param pose_covariance: ``laplace``: inverse of the negative Hessian of the score; ``fixed``:
        diagonal ``fixed_pose_variances``; ``multi_ndt`` and ``multi_ndt_score``: fixed, but x and y
        from the scatter of alignments started at ``offsets_m`` around the result, or from the
        likelihoods there (Autoware's types 2 and 3; covariance.py).
    :param fixed_pose_variances: of x, y, z [m^2], roll, pitch, yaw [rad^2].
    :param offsets_m: ahead of and to the left of the result.
    :param temperature: difference of likelihoods that reduces a weight by the factor e.
    :raises ManycoreError: if a value is out of range.
    """

    voxel_size_m: float = 2.0
    coarse_levels: tuple[float, ...] = (2.0,)
    wide_levels: tuple[float, ...] = (4.0,)
    polish_levels: tuple[float, ...] = (0.5,)
    search: Search = "direct7"
    voxel_covariance: VoxelCovariance = "pcl"
    min_points_per_voxel: int = 6
    step_rule: StepRule = "trust_region"
    step_size: float = 0.1
    trans_epsilon: float = 0.01
    max_iterations: int = 30
    outlier_ratio: float = 0.55
    regularization_scale_factor: float = 0.0
    pose_covariance: PoseCovariance = "laplace"
    fixed_pose_variances: tuple[float, float, float, float, float, float] = (
        *(0.0225, 0.0225, 0.0225),
        *(0.000625, 0.000625, 0.000625),
    )
    offsets_m: Offsets = (
        *((0.0, 0.5), (0.0, -0.5)),
        *((0.5, 0.0), (-0.5, 0.0), (1.0, 0.0), (-1.0, 0.0)),
    )
    temperature: float = 0.05

    def __post_init__(self) -> None:
        self._check_words()
        self._check_number("voxel_size_m", self.voxel_size_m, 0.01, 1000)
        self._check_number("min_points_per_voxel", self.min_points_per_voxel, 3, 1_000_000)
        self._check_number("step_size", self.step_size, 1e-6, 100)
        self._check_number("trans_epsilon", self.trans_epsilon, 1e-9, self.step_size)
        self._check_number("max_iterations", self.max_iterations, 1, 10_000)
        self._check_number("outlier_ratio", self.outlier_ratio, 0.001, 0.999)
        self._check_number("regularization_scale_factor", self.regularization_scale_factor, 0, 1e6)
        for variance in self.fixed_pose_variances:
            self._check_number("fixed_pose_variances", variance, 0, math.inf)
        self._check_number("temperature", self.temperature, 1e-6, 1e6)
        self._check_offsets()
        self._check_levels()

    @property
    def second_look_levels(self) -> tuple[float, ...]:
        """Return the wide levels that count; empty where no scan is looked at again."""
        if not self.coarse_levels:
            return ()
        return tuple(factor for factor in self.wide_levels if factor > self.coarse_levels[0])

    @property
    def polishing_levels(self) -> tuple[float, ...]:
        """Return the polish levels that count."""
        is_plain = self.coarse_levels and not self.regularization_scale_factor
        return self.polish_levels if is_plain else ()

    @property
    def coarser_levels(self) -> tuple[float, ...]:
        """Return the levels of a map that are coarser than the voxel size, coarsest first."""
        return self.second_look_levels + self.coarse_levels

    def _check_words(self) -> None:
        hints = get_type_hints(type(self))
        for field in fields(self):
            words = get_args(hints[field.name])
            if words and isinstance(words[0], str) and getattr(self, field.name) not in words:
                found = getattr(self, field.name)
                raise _error(field.name, f"one of {', '.join(words)}", found)

    def _check_levels(self) -> None:
        for name in ("coarse_levels", "wide_levels"):
            factors = getattr(self, name)
            finer = 1.0
            for factor in reversed(factors):
                self._check_number(name, factor, 1.0, 100)
                if factor <= finer:
                    raise _error(name, "decreasing numbers above 1", factors)
                finer = factor
        for coarser, finer in pairwise((1.0, *self.polish_levels)):
            self._check_number("polish_levels", finer, 0.01, 1.0)
            if finer >= coarser:
                raise _error("polish_levels", "decreasing numbers below 1", self.polish_levels)
        if len(self.coarser_levels) + len(self.polish_levels) >= MAX_LEVELS:
            limit = f"at most {MAX_LEVELS - 1} with wide_levels and polish_levels"
            raise _error("coarse_levels", limit, self.coarser_levels + self.polish_levels)

    def _check_offsets(self) -> None:
        for offset in self.offsets_m:
            if len(offset) != 2:
                raise _error("offsets_m", "pairs of numbers", offset)
            for distance_m in offset:
                self._check_number("offsets_m", distance_m, -100, 100)
        if not self.offsets_m:
            raise _error("offsets_m", "at least one pair of numbers", self.offsets_m)

    def _check_number(self, name: str, value: float, min_value: float, max_value: float) -> None:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise _error(name, "a number", value)
        if not (math.isfinite(value) and min_value <= value <= max_value):
            raise _error(name, f"{min_value:g} to {max_value:g}", value)


def _error(name: str, expected: str, found: object) -> ManycoreError:
    return ManycoreError(f"{name}: expected {expected}, found {found!r}", EXIT_BAD_INPUT)
