# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Closed loops through gaps, tunnels and open places: errors compared with the covariance.

The node's tracking aligns and judges; guesses are the last published pose moved on by odometry.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rmw_manycore_py.bench.ndt.gap_worlds import (
    LIDAR,
    SQUARE_M,
    STREET_M,
    bare_tunnel,
    map_of,
    motorway,
    open_square,
    street_of_few_features,
)
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points, Pose
from rmw_manycore_py.ndt.simulation.drive import poses_along
from rmw_manycore_py.ndt.simulation.street import Street
from rmw_manycore_py.ndt.trust.looks import ScanAt

OURS = "rmw_manycore"
BEYOND_GAP, BEYOND_TUNNEL = "beyond 3 deviations after a gap", "beyond 3 deviations in a tunnel"
SURE_GAP = "sure, but more than 2.5 m off, after a gap"
BEYOND_OPEN = "beyond 3 deviations in open places"
SURE_OPEN, ERROR_OPEN = "sure, but more than 0.5 m off, in open places", "error in open places"
ERROR_GAP, ERROR_TUNNEL = "error after a gap", "error in a tunnel"
ERROR_BEHIND = "error behind a tunnel"
OPTIONS = MatcherOptions(search="radius")
NODE = "rmw_manycore_py.ndt.nodes.scan_matcher"  # imported where used: it needs ROS
PERIOD_S, SPEED_M_S = 0.1, 10.0
SCANS = 15  # before a gap, and after it
GAPS_S = (0.8, 1.5, 3.0)
STREET_LENGTH_M, TUNNEL_M = 200.0, 400.0
TUNNEL_DRIFT, WRONG_DRIFT = 0.05, 0.3
AHEAD_M = 12.0  # how far a guess that jumps does so
SURE_M = 2.5  # an alignment converges from there
MOTORWAY_M, FAST_M_S, SURE_OPEN_M = 300.0, 25.0, 0.5


@dataclass
class Sink:
    """Keeps the values of a report."""

    values: dict[str, object] = field(default_factory=dict)

    def value(self, key: str, value: object) -> None:
        """Keep a value."""
        self.values[key] = value

    def warn(self, message: str) -> None:
        """Ignore a message."""

    note = error = warn


@dataclass(frozen=True)
class Published:
    """A published pose: its error in x and y [m], in standard deviations, and what it claims."""

    error_m: float
    deviations: float
    is_sure: bool


Guess = Callable[[int, Pose, Pose], Pose]  # scan, last published pose, motion since then


def driven(
    street: Street, points: Points, path: Matrix, stamps_s: Matrix, guess: Guess
) -> list[Published | None]:
    """Return what is published for the scans along a path (S, 4, 4); None for refused ones."""
    voxel_map = VoxelMap.from_points(points, OPTIONS)
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(voxel_map)
    tracking: Any = importlib.import_module(f"{NODE}.tracking")
    own: Any = importlib.import_module(f"{NODE}.parameters")
    track = tracking.RobustTracking(
        matcher, own.MatcherParameters(), own.OwnParameters(recovery_after_scans=0)
    )
    track.map_changed(voxel_map)
    found: list[Published | None] = []
    last, since = path[0], 0
    for index, truth in enumerate(path):
        at = guess(index, last, poses.inverse(path[since]) @ truth)
        scan = LIDAR.scan(street, truth, np.random.default_rng((5, index)))
        sink = Sink()
        tracked = track.track(ScanAt(float(stamps_s[index]), scan, at, None), sink)
        if not tracked.is_reliable:
            found.append(None)
            continue
        last, since = tracked.alignment.T_map_sensor, index
        error = last[:2, 3] - truth[:2, 3]
        squared = float(error @ np.linalg.solve(tracked.covariance[:2, :2], error))
        is_sure = bool(sink.values["is_sure"])
        found.append(Published(float(np.linalg.norm(error)), squared**0.5, is_sure))
    track.close()
    return found


def with_drift(motion: Pose, drift: float) -> Pose:
    """Return a motion whose length is wrong by a share."""
    wrong: Pose = motion.copy()
    wrong[:3, 3] *= 1.0 + drift
    return wrong


def guesses(kind: str, gap_s: float) -> Guess:
    """Return guesses that stay, jump, or follow wrong odometry at the first scan after a gap."""

    def guess(index: int, last: Pose, motion: Pose) -> Pose:
        if kind == "odometry 30 % off":
            motion = with_drift(motion, WRONG_DRIFT)
        elif index == SCANS:
            motion = np.eye(4)
        at: Pose = last @ motion
        if index != SCANS:
            return at
        at[0, 3] += SPEED_M_S * gap_s + AHEAD_M if kind == "jumps" else 0.0
        return at

    return guess


def after_gaps(seeds: Sequence[int], gaps_s: Sequence[float]) -> list[Published | None]:
    """Return what is published after gaps in streets of few features."""
    found: list[Published | None] = []
    for seed in seeds:
        street = street_of_few_features(STREET_LENGTH_M, seed)
        points = map_of(street, STREET_LENGTH_M)
        for gap_s in gaps_s:
            stamps_s: Matrix = PERIOD_S * np.arange(2 * SCANS, dtype=np.float64)
            stamps_s[SCANS:] += gap_s
            path = poses_along(10.0 + SPEED_M_S * stamps_s)
            for kind in ("stays", "jumps", "odometry 30 % off"):
                found += driven(street, points, path, stamps_s, guesses(kind, gap_s))[SCANS:]
    return found


def through_tunnel(length_m: float) -> tuple[list[Published | None], list[Published | None]]:
    """Return what is published in a tunnel, and on the last 20 m behind it."""
    street = bare_tunnel(length_m)
    points = map_of(street, length_m + 2 * STREET_M)
    x = np.arange(20.0, length_m + 110.0, SPEED_M_S * PERIOD_S)
    found = driven(
        street,
        points,
        poses_along(x),
        PERIOD_S * np.arange(len(x), dtype=np.float64),
        lambda _, last, motion: last @ with_drift(motion, TUNNEL_DRIFT),
    )
    return found[:-20], found[-20:]


def in_open_places(seeds: Sequence[int]) -> list[Published | None]:
    """Return what is published on motorways and squares."""
    found: list[Published | None] = []
    for seed in seeds:
        for street, length_m, speed_m_s in (
            (motorway(MOTORWAY_M, seed), MOTORWAY_M, FAST_M_S),
            (open_square(seed), SQUARE_M, SPEED_M_S),
        ):
            x = np.arange(10.0, length_m - 10.0, speed_m_s * PERIOD_S)
            found += driven(
                street,
                map_of(street, length_m),
                poses_along(x),
                PERIOD_S * np.arange(len(x), dtype=np.float64),
                lambda _, last, motion: last @ with_drift(motion, TUNNEL_DRIFT),
            )
    return found


def measure(run: Run) -> list[Result]:
    """Return shares and errors."""
    if not run.wants(QUESTION.name):
        return []
    is_short = run.share < 1.0
    run.note(f"{QUESTION.name}: gaps")
    gaps = after_gaps((1,) if is_short else (1, 2, 3), GAPS_S[:1] if is_short else GAPS_S)
    run.note(f"{QUESTION.name}: tunnel")
    inside, behind = through_tunnel(TUNNEL_M * min(1.0, 4.0 * run.share))
    run.note(f"{QUESTION.name}: open places")
    is_open = in_open_places((1,) if is_short else (1, 2, 3))
    return [
        _share(BEYOND_GAP, gaps, lambda one: one.deviations > 3.0),
        _share(SURE_GAP, gaps, lambda one: one.is_sure and one.error_m > SURE_M),
        _errors(ERROR_GAP, gaps),
        _share(BEYOND_TUNNEL, inside, lambda one: one.deviations > 3.0),
        _errors(ERROR_TUNNEL, inside),
        _errors(ERROR_BEHIND, behind),
        _share(BEYOND_OPEN, is_open, lambda one: one.deviations > 3.0),
        _share(SURE_OPEN, is_open, lambda one: one.is_sure and one.error_m > SURE_OPEN_M),
        _errors(ERROR_OPEN, is_open),
        _published(gaps + inside + is_open),
    ]


def _published(found: Sequence[Published | None]) -> Result:
    return Result("published", OURS, "%", tuple(100.0 * (one is not None) for one in found))


def _share(
    question: str, found: Sequence[Published | None], is_so: Callable[[Published], bool]
) -> Result:
    return Result(question, OURS, "%", tuple(100.0 * is_so(one) for one in found if one))


def _errors(question: str, found: Sequence[Published | None]) -> Result:
    return Result(question, OURS, "m", tuple(one.error_m for one in found if one))


QUESTION = Question(
    "gaps",
    measure,
    (
        Goal(BEYOND_GAP, OURS, "within", 1.0, statistic="mean"),
        Goal(BEYOND_TUNNEL, OURS, "within", 1.0, statistic="mean"),
        Goal(BEYOND_OPEN, OURS, "within", 1.0, statistic="mean"),
    ),
    "simulated, on the calling thread",
)
