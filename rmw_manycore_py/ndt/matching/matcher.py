# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The matcher: one signature for the calling thread and for workers."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.ndt.geometry.arrays import (
    Pose,
    ScanPoints,
    pose_error,
    pose_matrix,
    scan_points,
)
from rmw_manycore_py.ndt.matching import covariance
from rmw_manycore_py.ndt.matching.alignment import Alignment, Score
from rmw_manycore_py.ndt.matching.closer_look import closer_looks
from rmw_manycore_py.ndt.matching.evidence import Evidence, sample_of
from rmw_manycore_py.ndt.matching.level import levelled
from rmw_manycore_py.ndt.matching.native_matcher import NativeMatcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.places import best_place, places_around
from rmw_manycore_py.ndt.matching.question import Question, question_of
from rmw_manycore_py.ndt.matching.second_look import (
    CONVINCING_SHARE,
    Convinces,
    best_of,
    best_of_second_look,
)
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

CANNOT_WORK = "the matcher cannot work"  # out of memory, or workers keep dying
BUILT_FOR = (  # options that matcher and map must agree on
    *("voxel_size_m", "coarse_levels", "second_look_levels", "polishing_levels"),
    *("search", "voxel_covariance"),
)
DOUBTFUL_SPREAD_M = 0.3  # above, most of what constrains a scan may be the pattern of the ground
UNCONSTRAINED_M2 = 1e4 * np.eye(2)
FEWEST_POINTS = 6  # a pose has six unknowns; each point on a surface fixes one


class Matcher:
    """Matches scans to a map. Not thread-safe; the map may be swapped between alignments.

    Bad input is reported in the result, see :class:`Alignment`.

    :raises ManycoreError: for programming errors (arrays of a wrong shape, no map, a map built with
        other options) and if the matcher cannot work (out of memory, workers keep dying). The
        matcher remains usable.
    """

    def __init__(self, options: MatcherOptions, native: NativeMatcher) -> None:
        self.options = options
        self._native = native
        self._map: VoxelMap | None = None
        # Called after each alignment with its start [ns, CLOCK_MONOTONIC].
        self.on_aligned: Callable[[int], None] | None = None

    def __enter__(self) -> Matcher:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Release the matcher's resources."""
        self._map = None

    def set_map(self, voxel_map: VoxelMap) -> None:
        """Use this map from now on."""
        for name in BUILT_FOR:
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
        """Return the process ids of the workers; none on the calling thread."""
        return []

    def passes(self) -> list[tuple[int, int, int, int]]:
        """Return worker, pass, start and end [ns, CLOCK_MONOTONIC] of the last result's passes."""
        return []

    def shared_bytes(
        self,
        points: int = 0,  # noqa: ARG002 - on the calling thread nothing is shared
        next_map: VoxelMap | None = None,  # noqa: ARG002
    ) -> int:
        """Return the bytes shared with other processes after aligning a scan of `points` points.

        :param next_map: map about to replace the current one; both are held during the swap.
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

        If it does not fit, looks again (second_look.py), aligns closer, searches around the guess.

        :param T_map_guess: (4, 4) initial guess of T_map_sensor.
        :param T_map_regularization: (4, 4) pose that attracts the result along the vehicle's axis.
        :param only_pose: skip alignments and scores that only serve the covariance.
        """
        asked = self._asked(points, T_map_guess, T_map_regularization)
        return next(self._answers(asked, only_pose, lambda one: [self._looked(one)]))

    def align_once(
        self,
        points: ArrayLike,
        T_map_guess: ArrayLike,
        T_map_regularization: ArrayLike | None = None,
        *,
        only_pose: bool = False,
        is_wide: bool = False,
    ) -> Alignment:
        """Return the result of :meth:`align` without a second look.

        :param is_wide: align to the levels of a second look first.
        """
        asked = self._asked(points, T_map_guess, T_map_regularization)
        align = partial(self._aligned, is_wide=is_wide)
        return next(self._answers(asked, only_pose, lambda one: [align(one)]))

    def closer_looks(
        self,
        points: ArrayLike,
        T_map_guess: ArrayLike,
        T_map_regularization: ArrayLike | None = None,
        *,
        only_pose: bool = False,
    ) -> Iterator[Alignment]:
        """Yield alignments to the finest level alone (closer_look.py), computed when asked for."""
        asked = self._asked(points, T_map_guess, T_map_regularization)
        return self._answers(asked, only_pose, self._closely)

    def second_look(
        self,
        first: Alignment,
        points: ArrayLike,
        T_map_guess: ArrayLike,
        T_map_regularization: ArrayLike | None = None,
        convinces: Convinces | None = None,
    ) -> Alignment:
        """Return the best of a second look and of `first`, which :meth:`align_once` found.

        :param convinces: returns whether a result ends the look; None uses the map's own score.
        """
        asked = self._asked(points, T_map_guess, T_map_regularization)
        if isinstance(asked, Alignment) or first.is_refused or not self.options.second_look_levels:
            return first
        found = self._looked_again(first, asked, convinces or self._convinces)
        return self._with_covariance(found, asked)

    def look_around(
        self,
        first: Alignment,
        points: ArrayLike,
        T_map_guess: ArrayLike,
        T_map_regularization: ArrayLike | None = None,
    ) -> Alignment:
        """Return the best of `first` and places up to 10 m around the guess (places.py)."""
        asked = self._asked(points, T_map_guess, T_map_regularization)
        if isinstance(asked, Alignment) or first.is_refused:
            return first
        found = self._looked_around(first, asked)
        is_first = found.T_map_sensor is first.T_map_sensor
        return found if is_first else self._with_covariance(found, asked)

    def _asked(
        self, points: ArrayLike, T_map_guess: ArrayLike, T_map_regularization: ArrayLike | None
    ) -> Question | Alignment:
        """Return what to align, or the answer if that is not possible."""
        self._require_map()
        return question_of(points, T_map_guess, T_map_regularization, self.options)

    def _answers(
        self,
        asked: Question | Alignment,
        only_pose: bool,
        align: Callable[[Question], Iterable[Alignment]],
    ) -> Iterator[Alignment]:
        """Yield what `align` finds, with its covariance if needed, or why nothing can be found."""
        if isinstance(asked, Alignment):
            yield asked
            return
        for found in align(asked):
            yield found if only_pose else self._with_covariance(found, asked)

    def _convinces(self, alignment: Alignment) -> bool:
        """Return whether a result needs no further look, by the map's own score."""
        if not self.options.coarse_levels:
            return True
        least = CONVINCING_SHARE * self._require_map().own_score
        return alignment.converged and alignment.known_fit > least

    def _looked(self, asked: Question) -> Alignment:
        """Return the first result that convinces of those tried in turn, else the best fit."""
        is_far = bool(self.options.second_look_levels)
        again = partial(self._looked_again, convinces=self._convinces)
        looks = (again, self._looked_closer, self._looked_around)
        if self.options.coarse_levels:
            min_fit = CONVINCING_SHARE * self._require_map().own_score
            asked = replace(asked, min_fit=min_fit)
        found = self._weighed(asked, self._aligned(asked))
        for look in looks if is_far else (self._looked_closer,):
            if found.is_refused or self._convinces(found):
                break
            found = look(found, asked)
        return self._finished(found, asked)

    def _finished(self, found: Alignment, asked: Question) -> Alignment:
        """Return a result that all points refine."""
        if not found.is_unfinished:
            return found
        there = replace(asked, guess=found.T_map_sensor, min_fit=-np.inf)
        done = self._aligned(there, is_close=True).continued_from(found)
        explained = found.explained_score
        return replace(done, first=found.first, looks=found.looks, explained_score=explained)

    def _weighed(self, asked: Question, found: Alignment) -> Alignment:
        """Return a result that convinces by its fit, else with its explained score."""
        return found if self._convinces(found) else self.explained(found, asked.scan)

    def _looked_closer(self, first: Alignment, asked: Question) -> Alignment:
        """Return what fits best: `first`, or an alignment to the finest level alone."""
        closer = map(partial(self._weighed, asked), self._closely(asked))
        return best_of(first, closer, self._convinces)

    def _closely(self, asked: Question) -> Iterator[Alignment]:
        """Align to the finest level alone (closer_look.py)."""
        voxel_map, outlier_ratio = self._require_map(), self.options.outlier_ratio
        return closer_looks(asked, voxel_map, outlier_ratio, self._aligned, self.score)

    def _looked_again(self, first: Alignment, asked: Question, convinces: Convinces) -> Alignment:
        def aligned_widely(start: Pose, surpassed: float) -> Alignment:
            there = replace(asked, guess=start)
            return self._weighed(asked, self._aligned(there, is_wide=True, surpassed=surpassed))

        return best_of_second_look(first, asked.guess, aligned_widely, convinces)

    def _looked_around(self, first: Alignment, asked: Question) -> Alignment:
        """Return the best of `first` and places around the guess (places.py)."""
        first = self._finished(first, asked)  # the search believes its roll and pitch
        voxel_map, upright = self._require_map(), first.T_map_sensor
        starts = places_around(voxel_map, asked.scan, asked.guess, upright)
        found = [first, *(self._aligned(replace(asked, guess=start)) for start in starts)]
        explained = [self.explained(one, asked.scan) for one in found]
        best = best_place(explained, asked.guess)
        return replace(best, looks=first.looks + len(starts))

    def _aligned(
        self,
        asked: Question,
        *,
        is_wide: bool = False,
        is_close: bool = False,
        polish: bool = True,
        surpassed: float = -np.inf,
    ) -> Alignment:
        voxel_map = self._require_map()
        polishing = voxel_map.polishing if polish else 0
        levels = voxel_map.levels[: voxel_map.scored + 1 + polishing]
        first = voxel_map.scored if is_close else 0 if is_wide else voxel_map.first
        guess = asked.guess
        level = levelled(asked.scan, guess)
        begin_ns = time.monotonic_ns()
        with translate_native_errors(CANNOT_WORK):
            result = self._native.align(
                *(levels, level.points, level.guess, asked.position),
                *(first, polishing, surpassed, asked.min_fit),
            )
        if self.on_aligned is not None:
            self.on_aligned(begin_ns)
        points = result.at.scan_points
        if points == 0:
            return Alignment.refused(guess, "the scan has no finite point", self.options)
        if points < FEWEST_POINTS:
            few = f"{points} finite points do not constrain a pose"
            return Alignment.refused(guess, f"too few points: {few}", self.options)
        found = Alignment.of(result, self.options)
        return replace(
            found,
            T_map_sensor=level.result(found.T_map_sensor),
            path=level.result(found.path),
        )

    def _with_covariance(self, alignment: Alignment, asked: Question) -> Alignment:
        """Return the alignment with a covariance estimated from further evaluations, if needed."""

        def result(guess: Pose) -> Pose:
            return self._aligned(replace(asked, guess=guess), polish=False).T_map_sensor

        def likelihood(pose: Pose) -> float:
            return self.score(asked.scan, pose).nearest_voxel_likelihood

        return covariance.estimated(alignment, self.options, result, likelihood)

    def score(self, points: ArrayLike, T_map_sensor: ArrayLike) -> Score:
        """Return the score of points (N, 3) at a pose (4, 4); zero for an invalid scan or pose."""
        voxel_map = self._require_map()
        scan = scan_points(points)
        pose = pose_matrix(T_map_sensor)
        if pose_error(pose):
            return Score(0.0, 0.0, 0.0, 0)
        with translate_native_errors(CANNOT_WORK):
            found = self._native.evaluate(voxel_map.levels, scan, pose, voxel_map.polishing)
        return Score.of(found)

    @property
    def map(self) -> VoxelMap:
        """Return the map in use.

        :raises ManycoreError: if there is none yet.
        """
        return self._require_map()

    def work_on(self, search: _ndt.PlaceSearch, descends: bool, for_s: float) -> bool:
        """Work on a phase of a search for some time; return whether all of it is done.

        :param descends: the second phase, which looks into the squares that the first one ranks.
        """
        with translate_native_errors(CANNOT_WORK):
            return self._native.search(search, descends, for_s)

    def explained(self, alignment: Alignment, points: ArrayLike) -> Alignment:
        """Return an alignment of points (N, 3) with its `explained_score`.

        Takes a few milliseconds on the calling thread, so only for results in doubt.
        """
        if alignment.is_degenerate or alignment.explained_score > 0.0:
            return alignment
        score = self.explained_score(points, alignment.T_map_sensor)
        return replace(alignment, explained_score=score)

    def explained_score(self, points: ArrayLike, T_map_sensor: Pose) -> float:
        """Return the score of points (N, 3) at a pose that the map can contradict (evidence.py)."""
        return self._evidence(points, T_map_sensor)[1].explained_score()

    def raised(self, alignment: Alignment, points: ArrayLike) -> Alignment:
        """Return an alignment of points (N, 3) with its `raised_spread_m2`, if that matters."""
        widest_m2 = np.linalg.eigvalsh(alignment.xy_spread_m2)[1]
        if alignment.is_degenerate or widest_m2 < DOUBTFUL_SPREAD_M**2:
            return alignment
        sample, evidence = self._evidence(points, alignment.T_map_sensor)
        voxel_map, raised_m2 = self._require_map(), UNCONSTRAINED_M2
        if evidence.raised.any():
            of_map = (voxel_map.levels, sample[evidence.raised], alignment.T_map_sensor)
            covariance = self._native.evaluate(*of_map, voxel_map.polishing).covariance
            if covariance is not None:
                raised_m2 = covariance[:2, :2] * len(sample)
        return replace(alignment, raised_spread_m2=raised_m2)

    def _evidence(self, points: ArrayLike, T_map_sensor: Pose) -> tuple[ScanPoints, Evidence]:
        """Return some of points (N, 3), and what the map says about them."""
        sample = sample_of(scan_points(points))
        ratio = self.options.outlier_ratio
        return sample, Evidence.of(self._require_map(), sample, T_map_sensor, ratio)

    def point_scores(self, points: ArrayLike, T_map_sensor: ArrayLike) -> NDArray[np.float32]:
        """Return for each of points (N, 3) at a pose (4, 4) the score of its best voxel (N,).

        NaN for points without voxels around; the mean of the others is the nearest-voxel
        likelihood.
        """
        voxel_map = self._require_map()
        scan = scan_points(points)
        pose = pose_matrix(T_map_sensor)
        if pose_error(pose):
            return np.full(len(scan), np.nan, np.float32)
        return voxel_map.finest.point_scores(scan, pose, self.options.outlier_ratio)

    def _require_map(self) -> VoxelMap:
        if self._map is None:
            raise ManycoreError("the matcher has no map: call set_map first", EXIT_BAD_INPUT)
        return self._map
