# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Motion between consecutive scans, as odometry would measure it.

A motion is T_before_after (4, 4): the sensor's pose at a scan, relative to the previous scan.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.serial_matcher import SerialMatcher
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.recordings.recording import Recording

VOXEL_M = 0.25  # scans are downsampled to about ten thousand points
# An alignment converges from about ten degrees and two metres.
TURNS_RAD = np.radians(np.arange(-60.0, 61.0, 15.0))
OPTIONS = MatcherOptions()  # the matcher's defaults, with all levels
# Right motions have 2.68 and more, wrong ones 2.54 and less (docs/design/ndt_replay.md).
MIN_LIKELIHOOD = 2.6


def of_reference(drive: Recording) -> Iterator[Matrix]:
    """Yield the motions of the reference poses."""
    for before, after in zip(drive.poses[:-1], drive.poses[1:], strict=True):
        yield poses.inverse(before) @ after


def of_scans(drive: Recording, doubt: Callable[[str], None]) -> Iterator[Matrix | None]:
    """Yield the motions that best align each scan with the previous one; uses no poses.

    :param doubt: called with the reason if the scans do not determine their motion (None).
    """
    matcher = SerialMatcher(OPTIONS)
    motion: Matrix = np.eye(4)
    before = _thinned(drive, 0)
    for index in range(1, len(drive)):
        after = _thinned(drive, index)
        fit = _best_fit(matcher, before, after, motion)
        problem = _problem(fit)
        before = after
        if fit is None or problem:
            doubt(f"from scan {index - 1} to scan {index}: {problem}")
            yield None
        else:
            motion = fit.T_map_sensor
            yield motion


def drifted(motion: Matrix, drift: float, generator: np.random.Generator) -> Matrix:
    """Return a motion with a random error proportional to its length and angle."""
    length_m = float(np.linalg.norm(motion[:3, 3]))
    angle_rad = float(np.linalg.norm(poses.rotation_vector(motion[:3, :3])))
    return poses.perturbed(motion, drift * length_m, drift * angle_rad, generator)


def _best_fit(matcher: Matcher, before: Points, after: Points, last: Matrix) -> Alignment | None:
    """Return the likeliest alignment from the last motion and from turns of up to 60 degrees."""
    try:
        matcher.set_map(VoxelMap.from_points(before, matcher.options))
    except ManycoreError:
        return None  # too few points
    guesses = [last, *(poses.from_xyz_rpy(last[:3, 3], (0.0, 0.0, turn)) for turn in TURNS_RAD)]
    fits = [matcher.align_once(after, guess, only_pose=True) for guess in guesses]
    return max(fits, key=lambda fit: fit.transform_probability)


def _problem(fit: Alignment | None) -> str:
    """Return why a fit may be wrong; "" if it is trusted."""
    if fit is None:
        return "the former has too few points"
    if not fit.converged:
        return fit.why
    found = fit.nearest_voxel_likelihood
    return "" if found >= MIN_LIKELIHOOD else f"likelihood {found:.2f} of {MIN_LIKELIHOOD:g}"


def _thinned(drive: Recording, index: int) -> Points:
    return voxel_centroids(drive.scan(index), (VOXEL_M,) * 3)
