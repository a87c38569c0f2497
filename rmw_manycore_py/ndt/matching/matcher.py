# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The matcher, on the calling thread or on workers: one signature."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from types import TracebackType
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rmw_manycore_py import _ndt
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import (
    Pose,
    ScanPoints,
    pose_matrix,
    scan_points,
    why_no_pose,
)
from rmw_manycore_py.ndt.matching import covariance
from rmw_manycore_py.ndt.matching.alignment import Alignment, Score
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.level import levelled
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

Position = tuple[float, float]

CANNOT_WORK = "the matcher cannot work"  # no memory, or workers die again and again
FEWEST_POINTS = 6  # a pose has six unknowns, and the surface that a point lies on fixes one


class NativeMatcher(Protocol):
    """What the kernel offers, alone or with workers."""

    def align(
        self,
        maps: list[_ndt.VoxelMap],
        points: ScanPoints,
        guess: Pose,
        regularization_position_m: Position | None = None,
    ) -> _ndt.NewtonResult:
        """Align from a guess, to one map after the other."""
        ...

    def evaluate(
        self,
        maps: list[_ndt.VoxelMap],
        points: ScanPoints,
        pose: Pose,
    ) -> _ndt.Derivatives:
        """Return score and derivatives at a pose, of the last map."""
        ...


class Matcher:
    """Matches scans to a map. Not for several threads at once; the map may be swapped in between.

    Bad input is answered, not raised: see :class:`Alignment`. Raised are only mistakes of the
    calling program (arrays of a wrong shape, no map, a map built for other options), and what
    keeps the matcher from working: no memory, workers that die again and again. Each is a
    ManycoreError, and the matcher may be used on.
    """

    def __init__(self, options: MatcherOptions, native: NativeMatcher) -> None:
        self.options = options
        self._native = native
        self._map: VoxelMap | None = None
        # Called after each alignment with its begin [ns, CLOCK_MONOTONIC].
        self.on_aligned: Callable[[int], None] | None = None

    def __enter__(self) -> Matcher:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give back what the matcher holds."""
        self._map = None

    def set_map(self, voxel_map: VoxelMap) -> None:
        """Match to this map from now on."""
        for name in ("voxel_size_m", "coarse_levels", "search", "voxel_covariance"):
            found = getattr(voxel_map.options, name)
            expected = getattr(self.options, name)
            if found != expected:
                raise ManycoreError(
                    f"map: expected one built with {name}={expected!r}, found {found!r}",
                    EXIT_BAD_INPUT,
                )
        self._map = voxel_map

    @property
    def worker_pids(self) -> list[int]:
        """Return the process ids of the workers, of which the calling thread needs none."""
        return []

    def passes(self) -> list[tuple[int, int, int, int]]:
        """Return worker, pass, begin and end [ns, CLOCK_MONOTONIC] of the last answer's passes."""
        return []

    def shared_bytes(
        self,
        points: int = 0,  # noqa: ARG002 - on the calling thread nothing is shared
        next_map: VoxelMap | None = None,  # noqa: ARG002
    ) -> int:
        """Return the memory shared with other processes, once a scan of so many points is aligned.

        :param next_map: one that is about to follow the present one, beside which it lies then.
        """
        return 0

    def align(
        self,
        points: ArrayLike,
        T_map_guess: ArrayLike,
        T_map_regularization: ArrayLike | None = None,
        *,
        only_pose: bool = False,
    ) -> Alignment:
        """Find the pose near the guess (4, 4) at which points (N, 3) [m, sensor frame] fit best.

        :param T_map_regularization: a pose (4, 4) to keep near along the vehicle's axis.
        :param only_pose: spare the alignments and scores that only the covariance is made of.
        """
        voxel_map = self._require_map()
        scan = scan_points(points)
        guess = pose_matrix(T_map_guess)
        wrong = why_no_pose(guess)
        if wrong:
            return Alignment.refused(None, f"the guess {wrong}", self.options)
        position = None
        if T_map_regularization is not None:
            regularization = pose_matrix(T_map_regularization)
            wrong = why_no_pose(regularization)
            if wrong:
                return Alignment.refused(guess, f"the regularization pose {wrong}", self.options)
            position = (float(regularization[0, 3]), float(regularization[1, 3]))
        alignment = self._aligned(voxel_map, scan, guess, position)
        if only_pose or alignment.is_degenerate:
            return alignment
        return self._with_covariance(alignment, voxel_map, scan, position)

    def _aligned(
        self, voxel_map: VoxelMap, scan: ScanPoints, guess: Pose, position: Position | None
    ) -> Alignment:
        level = levelled(scan, guess)
        begin_ns = time.monotonic_ns()
        with translate_native_errors(CANNOT_WORK):
            result = self._native.align(voxel_map.levels, level.points, level.guess, position)
        if self.on_aligned is not None:
            self.on_aligned(begin_ns)
        points = result.at.scan_points
        if points == 0:
            return Alignment.refused(guess, "the scan has no finite point", self.options)
        if points < FEWEST_POINTS:
            few = f"{points} finite points do not say where a scan fits"
            return Alignment.refused(guess, f"too few points: {few}", self.options)
        found = Alignment.of(result, self.options)
        return replace(
            found,
            T_map_sensor=level.result(found.T_map_sensor),
            path=level.result(found.path),
        )

    def _with_covariance(
        self,
        alignment: Alignment,
        voxel_map: VoxelMap,
        scan: ScanPoints,
        position: Position | None,
    ) -> Alignment:
        """Return the alignment with what takes more than itself to know its covariance."""
        kind = self.options.pose_covariance
        if kind not in ("multi_ndt", "multi_ndt_score"):
            return alignment
        around = covariance.poses_around(alignment.T_map_sensor, self.options.offsets_m)
        results: list[Pose] = []
        if kind == "multi_ndt":
            results = [self._aligned(voxel_map, scan, T, position).T_map_sensor for T in around]
            found = covariance.from_results(alignment, results)
        else:
            likelihoods = [self.score(scan, T).nearest_voxel_likelihood for T in around]
            found = covariance.from_likelihoods(
                alignment, around, likelihoods, self.options.temperature
            )
        return replace(
            alignment,
            covariance=found,
            guesses_around=tuple(around),
            results_around=tuple(results),
        )

    def score(self, points: ArrayLike, T_map_sensor: ArrayLike) -> Score:
        """Return how well points (N, 3) fit at a pose (4, 4); 0 for what is no scan or no pose."""
        voxel_map = self._require_map()
        scan = scan_points(points)
        pose = pose_matrix(T_map_sensor)
        if why_no_pose(pose):
            return Score(0.0, 0.0, 0.0, 0)
        with translate_native_errors(CANNOT_WORK):
            return Score.of(self._native.evaluate(voxel_map.levels, scan, pose))

    def point_scores(self, points: ArrayLike, T_map_sensor: ArrayLike) -> NDArray[np.float32]:
        """Return for each of points (N, 3) at a pose (4, 4) the score of its best voxel (N,).

        NaN where a point sees no voxel; the mean of the others is the likelihood of the nearest
        voxels. On the calling thread alone, one point after the other: for pictures.
        """
        voxel_map = self._require_map()
        scan = scan_points(points)
        pose = pose_matrix(T_map_sensor)
        if why_no_pose(pose):
            return np.full(len(scan), np.nan, np.float32)
        return voxel_map.finest.point_scores(scan, pose, self.options.outlier_ratio)

    def _require_map(self) -> VoxelMap:
        if self._map is None:
            raise ManycoreError("the matcher has no map: call set_map first", EXIT_BAD_INPUT)
        return self._map


class SerialMatcher(Matcher):
    """Matches on the calling thread."""

    def __init__(self, options: MatcherOptions | None = None) -> None:
        options = options or MatcherOptions()
        super().__init__(options, _ndt.SerialMatcher(match_options(options)))
