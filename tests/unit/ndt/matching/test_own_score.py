# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map's own score is what unseen points of the same place reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.matching.kernel_options import map_options

pytestmark = pytest.mark.unit

OPTIONS = MatcherOptions(search="direct1", coarse_levels=())
CELLS = 40  # of 2 m, along x and along y
AT = np.eye(4)


def bushes(seed: int, per_voxel: int) -> Matrix:
    """Return points (N, 3) scattered around the middles of voxels, in random order."""
    generator = np.random.default_rng(seed)
    middles = 2.0 * np.stack(np.mgrid[:CELLS, :CELLS], axis=-1).reshape(-1, 2) + 1.0
    middles = np.column_stack([middles, np.ones(len(middles))])
    points = np.repeat(middles, per_voxel, axis=0)
    return generator.permutation(points + generator.normal(0.0, 0.15, points.shape))


@pytest.mark.parametrize("per_voxel", [10, 20, 200])
def test_scans_of_what_is_mapped_reach_it(per_voxel):
    points = bushes(1, per_voxel)
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(VoxelMap.from_points(points, OPTIONS))
    own = matcher.map.own_score
    again = matcher.score(bushes(2, 20), AT)
    assert again.nearest_voxel_likelihood == pytest.approx(own, rel=0.08)
    of_its_own = matcher.score(points, AT).nearest_voxel_likelihood
    assert (of_its_own > 1.1 * own) == (per_voxel < 100)


@pytest.mark.parametrize(("beside_m", "counts"), [(0.0, True), (200.0, False)])
def test_points_that_see_no_voxel_count_above_others(beside_m, counts):
    """As in crowns of trees. A scan near the vehicle has few of those beside the map."""
    side_m = 2.0 * CELLS
    few = np.random.default_rng(3).uniform((0, 0, 4), (side_m, side_m, 40), (8000, 3))
    few[:, 0] += beside_m
    mapped = bushes(1, 60)
    points = np.random.default_rng(4).permutation(np.concatenate([mapped, few]))
    full = VoxelMap.from_points(mapped, OPTIONS).own_score
    share = len(mapped) / len(points) if counts else 1.0
    assert VoxelMap.from_points(points, OPTIONS).own_score == pytest.approx(share * full, rel=0.03)


def test_it_is_not_lost_with_the_voxels_of_a_thinned_map():
    """Each of eight points that is held out leaves too few for a voxel."""
    thinned = np.stack(np.mgrid[:60, :60, :2], axis=-1).reshape(-1, 3) + 0.5
    thinned = thinned[np.random.default_rng(1).permutation(len(thinned))]
    options = replace(OPTIONS, min_points_per_voxel=8)
    matcher = SerialMatcher(options)
    matcher.set_map(VoxelMap.from_points(thinned, options))
    of_its_own = matcher.score(thinned, AT).nearest_voxel_likelihood
    assert matcher.map.own_score > 0.8 * of_its_own


def test_every_nth_point_is_left_out():
    points = bushes(1, 8)
    kept = np.delete(points, np.s_[::3], axis=0)
    without = _ndt.VoxelMap(points, map_options(OPTIONS), without_every=3)
    of_kept = _ndt.VoxelMap(kept, map_options(OPTIONS))
    assert without.voxels == of_kept.voxels < CELLS**2
    scores = [one.point_scores(points.astype(np.float32), AT, 0.55) for one in (without, of_kept)]
    np.testing.assert_array_equal(*scores)


def test_a_map_of_one_small_voxel_and_what_is_not_finite_have_one_as_well():
    few = np.random.default_rng(1).normal(1.0, 0.1, (6, 3))
    assert VoxelMap.from_points(few, OPTIONS).own_score > 0.0
    points = bushes(1, 60)
    broken = points.copy()
    broken[::31] = np.nan  # all that is held out
    expected = VoxelMap.from_points(points, OPTIONS).own_score
    assert VoxelMap.from_points(broken, OPTIONS).own_score == pytest.approx(expected, rel=0.15)
