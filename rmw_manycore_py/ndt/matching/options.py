# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What can be chosen about a map and a match."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Literal, get_args, get_type_hints

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.words import Search, StepRule, VoxelCovariance

PoseCovariance = Literal["laplace", "fixed", "multi_ndt", "multi_ndt_score"]
Offsets = tuple[tuple[float, float], ...]
MAX_LEVELS = 4  # with the finest one; as the kernel has it


@dataclass(frozen=True)
class MatcherOptions:
    """Options of map and matcher; the defaults are Autoware's where it has them.

    Two differ, for they find home from farther off (docs/design/ndt.md): ``coarse_levels`` and
    ``voxel_covariance``.

    :param voxel_size_m: edge of a voxel; Autoware's and PCL's "resolution".
    :param coarse_levels: maps that a scan is aligned to first, coarsest first, by how many times as
        large their voxels are; empty for ``voxel_size_m`` alone, as PCL and Autoware have it.
    :param search: which voxels a point is held against. ``radius``: those whose mean is within one
        voxel size (PCL, Autoware); ``direct7``: its own and those across the six faces;
        ``direct1``: its own.
    :param voxel_covariance: covariance of a voxel from the scatter S of its n points. ``pcl``:
        S / (n - 1); ``autoware``: (I + S) / (n - 1); ``pclomp``: (I + S) (n - 1) / n^2. The
        identity, 1 m^2, widens voxels of few points.
    :param min_points_per_voxel: voxels with fewer points are left out; at least 3.
    :param step_rule: ``trust_region``: uphill also where the score is not concave, as far as the
        steps before turned out well (ours; docs/design/ndt.md); ``clamped``: Newton's step, at
        most ``step_size`` long (Autoware's default); ``more_thuente``: a line search up to
        ``step_size`` (PCL).
    :param step_size: longest step of the latter two, in metres and radians together.
    :param trans_epsilon: a shorter step ends the alignment.
    :param max_iterations: the alignment ends unconverged after so many steps.
    :param outlier_ratio: share of points expected to belong to nothing in the map.
    :param regularization_scale_factor: pull towards the regularization pose, along the vehicle's
        axis; 0 is none.
    :param pose_covariance: ``laplace``: the inverse of the score's negative Hessian; ``fixed``: the
        diagonal ``fixed_pose_variances``; ``multi_ndt`` and ``multi_ndt_score``: the same, but x
        and y as alignments from ``offsets_m`` around the result scatter, and as the likelihoods
        there say (Autoware's types 2 and 3; covariance.py).
    :param fixed_pose_variances: of x, y, z [m^2], roll, pitch, yaw [rad^2].
    :param offsets_m: ahead and to the left of the result.
    :param temperature: difference of likelihoods by which a place counts e times less.
    :raises ManycoreError: when a value is out of its range.
    """

    voxel_size_m: float = 2.0
    coarse_levels: tuple[float, ...] = (2.0,)
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

    def _check_words(self) -> None:
        hints = get_type_hints(type(self))
        for field in fields(self):
            words = get_args(hints[field.name])
            if words and isinstance(words[0], str) and getattr(self, field.name) not in words:
                found = getattr(self, field.name)
                raise _error(field.name, f"one of {', '.join(words)}", found)

    def _check_levels(self) -> None:
        finer = 1.0
        for factor in reversed(self.coarse_levels):
            self._check_number("coarse_levels", factor, 1.0, 100)
            if factor <= finer:
                raise _error("coarse_levels", "decreasing numbers above 1", self.coarse_levels)
            finer = factor
        if len(self.coarse_levels) >= MAX_LEVELS:
            raise _error("coarse_levels", f"at most {MAX_LEVELS - 1}", self.coarse_levels)

    def _check_offsets(self) -> None:
        for offset in self.offsets_m:
            if len(offset) != 2:
                raise _error("offsets_m", "pairs of numbers", offset)
            for distance_m in offset:
                self._check_number("offsets_m", distance_m, -100, 100)
        if not self.offsets_m:
            raise _error("offsets_m", "at least one pair of numbers", self.offsets_m)

    def _check_number(self, name: str, value: float, least: float, most: float) -> None:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise _error(name, "a number", value)
        if not (math.isfinite(value) and least <= value <= most):
            raise _error(name, f"{least:g} to {most:g}", value)


def _error(name: str, expected: str, found: object) -> ManycoreError:
    return ManycoreError(f"{name}: expected {expected}, found {found!r}", EXIT_BAD_INPUT)
