# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Right and wrong alignments, each with the history that a judge would have seen.

Cases and search results are passed between processes; a world stays in the process that built it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from rmw_manycore_py.bench.ndt.trust_variants import drives
from rmw_manycore_py.bench.ndt.trust_worlds import Drive
from rmw_manycore_py.ndt import Alignment, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Pose, ScanPoints, scan_points
from rmw_manycore_py.ndt.geometry.thinning import spread_indices
from rmw_manycore_py.ndt.matching.second_look import CONVINCING_SHARE
from rmw_manycore_py.ndt.trust.judge import PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel
from rmw_manycore_py.ndt.trust.search import Found, Region, search

MATCHED_POINTS = 30_000  # the node's limit
RIGHT_M, RIGHT_DEG = 0.2, 1.0
WRONG_M, WRONG_DEG = 0.5, 3.0
# Errors of guesses in random directions: metres, degrees. The last two are along the drive, in the
# direction of the next period of a repetitive street.
NEAR = ((0.3, 2.0), (1.0, 5.0), (2.0, 10.0))
FAR = ((3.0, 40.0), (5.0, 20.0), (8.0, 40.0), (15.0, 90.0), (1.0, 180.0))
ALONG_M = (12.0, 20.0)
NEAR_M, NEAR_RAD = 1.1, np.radians(6.0)
HISTORY = 20
HISTORY_M, HISTORY_RAD = 0.03, 0.003  # error of the preceding poses
SEED = 11
MIN_SCORES_BEFORE = 3
DOUBTFUL_SHARE = 0.8  # of the map's own score: above, foreign points may explain a first pose


@dataclass(frozen=True)
class Shares:
    """What a level is made of, as :class:`ScoreLevel` takes it."""

    of_map: float
    of_drive: float
    of_first: float
    of_explained: float

    def level(self) -> ScoreLevel:
        """Return a level that has learned nothing yet."""
        return ScoreLevel(self.of_map, self.of_drive, self.of_first, self.of_explained)


@dataclass(frozen=True)
class Before:
    """A preceding scan: its pose, guess and score."""

    stamp_s: float
    T: Pose
    guess: Pose
    score: float


@dataclass(frozen=True)
class World:
    """Map of a drive, and matchers for it."""

    drive: Drive
    voxel_map: VoxelMap
    matcher: SerialMatcher

    @classmethod
    def of(cls, drive: Drive) -> World:
        """Build the map."""
        voxel_map = VoxelMap.from_points(drive.map_points, drive.options)
        matcher = SerialMatcher(drive.options)
        matcher.set_map(voxel_map)
        return cls(drive, voxel_map, matcher)

    def scan(self, index: int) -> ScanPoints:
        """Return the points (N, 3) that the node would match."""
        points = scan_points(self.drive.scan(index))
        return scan_points(points[spread_indices(len(points), MATCHED_POINTS)])


@cache
def world_of(drive: str) -> World:
    """Return the world of the named drive."""
    return World.of(drives()[drive]())


def searched(drive: str, index: int, region: Region) -> Found:
    """Search for a scan of a drive like the node does."""
    world = world_of(drive)
    return search(world.matcher, world.scan(index), region)


@dataclass(frozen=True)
class Case:
    """Result of one alignment.

    :param drive: name of the drive; `index` is that of the scan.
    :param repeats: places of the drive cannot be told apart by a single scan.
    :param own_score: score of the map's own points.
    :param before: previously believed scans; empty at a start.
    :param truth: T_map_sensor.
    :param first: the alignment, or the best of places around the guess where foreign points may
        explain it as a first pose.
    """

    drive: str
    index: int
    is_drive: bool
    repeats: bool
    own_score: float
    stamp_s: float
    before: tuple[Before, ...]
    guess: Pose
    alignment: Alignment
    truth: Pose
    first: Alignment

    @property
    def is_right(self) -> bool:
        """Return whether the result is right."""
        return self.error_m < RIGHT_M and self.error_deg < RIGHT_DEG

    @property
    def is_wrong(self) -> bool:
        """Return whether the error is too large for the result to be useful; some are neither."""
        return self.error_m > WRONG_M or self.error_deg > WRONG_DEG

    @property
    def is_near(self) -> bool:
        """Return whether the guess is so near that its scan should get a pose."""
        is_near = poses.distance_m(self.guess, self.truth) < NEAR_M
        is_turned = poses.angle_rad(self.guess, self.truth) > NEAR_RAD
        return is_near and not is_turned and not self.repeats

    @property
    def score(self) -> float:
        """Return the score that is judged."""
        return max(self.alignment.nearest_voxel_likelihood, self.alignment.explained_score)

    @property
    def error_m(self) -> float:
        """Return the distance from the truth."""
        return poses.distance_m(self.alignment.T_map_sensor, self.truth)

    @property
    def error_deg(self) -> float:
        """Return the angle to the truth."""
        return float(np.degrees(poses.angle_rad(self.alignment.T_map_sensor, self.truth)))

    def level(self, shares: Shares) -> ScoreLevel:
        """Return the level in the drive's map, without a history."""
        level = shares.level()
        level.map_changed(self.own_score)
        return level

    def judged(self, shares: Shares) -> Verdict:
        """Return the verdict of a judge that has seen the history."""
        judge = PoseJudge(self.level(shares))
        for one in self.before:
            seen = replace(
                self.alignment,
                T_map_sensor=one.T,
                nearest_voxel_likelihood=one.score,
                explained_score=0.0,
            )
            judge.believe(one.stamp_s, seen, one.guess)
        return judge.judge(self.stamp_s, self.alignment, self.guess)


def looked_again(case: Case, shares: Shares) -> Case:
    """Return the case after the further looks that the node takes."""
    verdict, of_first = case.judged(shares), case.level(shares).of_first
    if verdict.is_believed and (case.before or case.alignment.fit > of_first):
        return case
    world = world_of(case.drive)
    scan = world.scan(case.index)

    def explained(found: Alignment) -> Case:
        return replace(case, alignment=world.matcher.explained(found, scan))

    def is_believed(looked: Case) -> bool:
        return looked.judged(shares).is_believed

    best = case
    if verdict.is_score_low or not case.alignment.converged:
        closer = world.matcher.closer_looks(scan, case.guess, only_pose=True)
        best = next(filter(is_believed, map(explained, closer)), case)
    if case.before and best is case:
        found = world.matcher.second_look(
            case.alignment,
            scan,
            case.guess,
            convinces=lambda found: is_believed(explained(found)),
        )
        return explained(found)
    if case.before or best.alignment.fit > of_first:
        return best
    around = explained(world.matcher.look_around(best.alignment, scan, case.guess))
    return around if is_believed(around) else best  # the rest is left to a search


def cases_of(name: str, count: int, wanted: int) -> list[Case]:
    """Return about `wanted` right and wrong results of a drive, and those in between.

    :param count: maximum number of aligned scans.
    """
    generator = np.random.default_rng(SEED)
    world = world_of(name)
    drive, matcher = world.drive, world.matcher
    scans = {index: world.scan(index) for index in _spread(drive.tested, count)}
    scores: dict[int, float] = {}
    for index, scan in scans.items():
        likelihood = matcher.score(scan, drive.poses[index]).nearest_voxel_likelihood
        scores[index] = max(likelihood, matcher.explained_score(scan, drive.poses[index]))
    found: list[Case] = []
    rounds = -(-wanted // len(scans))
    for index, scan in scans.items():
        before = _before(drive, index, scores, generator)
        for guess in _guesses(drive.poses[index], rounds, generator):
            alignment = matcher.align_once(scan, guess, only_pose=True)
            alignment = matcher.explained(alignment, scan)
            first, own = alignment, world.voxel_map.own_score
            fits = alignment.fit > CONVINCING_SHARE * own
            if not fits and alignment.explained_score > DOUBTFUL_SHARE * own:
                first = matcher.look_around(alignment, scan, guess)
            found.append(
                Case(
                    name,
                    index,
                    drive.is_drive,
                    drive.repeats,
                    own,
                    float(drive.stamps_s[index]),
                    before,
                    guess,
                    alignment,
                    drive.poses[index],
                    first,
                )
            )
    return found


def _spread(indices: list[int], count: int) -> list[int]:
    if len(indices) <= count:
        return indices
    return [indices[i] for i in np.linspace(0, len(indices) - 1, count).astype(int)]


def _before(
    drive: Drive, index: int, scores: dict[int, float], generator: np.random.Generator
) -> tuple[Before, ...]:
    """Return the preceding scans, with scores of tested ones."""
    if not drive.is_drive or sum(other < index for other in scores) < MIN_SCORES_BEFORE:
        return ()
    found = []
    for other in range(max(0, index - HISTORY), index):
        scored = max((one for one in scores if one <= other), default=min(scores))
        T = poses.perturbed(drive.poses[other], HISTORY_M, HISTORY_RAD, generator)
        guess = poses.perturbed(drive.poses[other], *_in_rad(NEAR[0]), generator)
        found.append(Before(float(drive.stamps_s[other]), T, guess, scores[scored]))
    return tuple(found)


def _guesses(truth: Pose, rounds: int, generator: np.random.Generator) -> Iterator[Pose]:
    """Yield near and far guesses, three of each per round."""
    for turn in range(rounds):
        yield poses.perturbed(truth, *_in_rad(NEAR[turn % len(NEAR)]), generator)
        for kind in range(2):
            distance_m, angle_deg = FAR[(2 * turn + kind) % len(FAR)]
            direction = generator.uniform(-np.pi, np.pi)
            turned = np.radians(generator.uniform(0.3, 1.0) * angle_deg)
            yield moved(truth, distance_m, direction, turned * generator.choice([-1.0, 1.0]))
        along = float(np.arctan2(truth[1, 0], truth[0, 0])) + generator.choice([0.0, np.pi])
        yield moved(truth, ALONG_M[turn % len(ALONG_M)], along)


def moved(truth: Pose, distance_m: float, direction_rad: float, yaw_rad: float = 0.0) -> Pose:
    """Return a pose moved in a direction of the map, and turned."""
    T: Matrix = truth.copy()
    T[:2, 3] += distance_m * np.array([np.cos(direction_rad), np.sin(direction_rad)])
    T[:3, :3] = poses.from_rotation_vector((0.0, 0.0, yaw_rad)) @ T[:3, :3]
    return T


def _in_rad(offset: tuple[float, float]) -> tuple[float, float]:
    return offset[0], float(np.radians(offset[1]))
