# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The motion between consecutive scans, which a vehicle's odometry would tell.

A motion is T_before_after (4, 4): the sensor's pose at a scan, seen from where it was at the scan
before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix, Points
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher, SerialMatcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.recordings.recording import Recording

VOXEL_M = 0.25  # scans are thinned to it, which leaves some ten thousand points
# From a guess beside the truth an alignment finds back over ten degrees and two metres.
TURNS_RAD = np.radians(np.arange(-60.0, 61.0, 15.0))
OPTIONS = MatcherOptions()  # what the matcher is given by default, levels and all
# Of right motions 2.68 and more, of wrong ones 2.54 and less (docs/design/ndt_node.md).
LEAST_LIKELIHOOD = 2.6


def of_reference(drive: Recording) -> Iterator[Matrix]:
    """Yield the motions of the reference poses."""
    for before, after in zip(drive.poses[:-1], drive.poses[1:], strict=True):
        yield poses.inverse(before) @ after


def of_scans(drive: Recording, doubt: Callable[[str], None]) -> Iterator[Matrix | None]:
    """Yield the motions by which each scan fits the one before it best; no pose is looked at.

    :param doubt: is told why, where the scans do not tell their motion (None).
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
    """Return a motion with an error of a share of its length and angle, in a random direction."""
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
    fits = [matcher.align(after, guess, only_pose=True) for guess in guesses]
    return max(fits, key=lambda fit: fit.transform_probability)


def _problem(fit: Alignment | None) -> str:
    """Say why a fit may be wrong, "" where it is trusted."""
    if fit is None:
        return "the former has too few points"
    if not fit.converged:
        return fit.why
    found = fit.nearest_voxel_likelihood
    return "" if found >= LEAST_LIKELIHOOD else f"likelihood {found:.2f} of {LEAST_LIKELIHOOD:g}"


def _thinned(drive: Recording, index: int) -> Points:
    return voxel_centroids(drive.scan(index), (VOXEL_M,) * 3)
