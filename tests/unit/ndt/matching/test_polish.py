# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finer levels refine a pose, and leave its scores and those of a sparse map alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.nodes.scan_matcher.matcher_options import matcher_options
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters
from support.nodes.scan_matching import TRUTH, street_map, street_scan
from support.samples.ndt_world import errors, pose, scan_at, street

pytestmark = pytest.mark.unit

WORLD = street()
POLISHING = MatcherOptions()
PLAIN = replace(POLISHING, polish_levels=())
FIRST_POINTS = 1024
PLACES_M = np.linspace(30, 50, 10)


def matcher(options: MatcherOptions, world: Points = WORLD) -> SerialMatcher:
    made = SerialMatcher(options)
    made.set_map(VoxelMap.from_points(world, options))
    return made


def test_poses_are_better_and_scores_those_of_the_voxel_size():
    plain, polishing = matcher(PLAIN), matcher(POLISHING)
    generator = np.random.default_rng(2)
    before_m, after_m = [], []
    for x in PLACES_M:
        true = pose(x, 0.5, 1.8, 0.01, -0.02, 0.3)
        scan, guess = scan_at(WORLD, true), poses.perturbed(true, 0.5, 0.05, generator)
        found = polishing.align(scan, guess)
        before_m.append(errors(plain.align(scan, guess).T_map_sensor, true)[0])
        after_m.append(errors(found.T_map_sensor, true)[0])
        here = plain.score(scan, found.T_map_sensor)
        assert found.nearest_voxel_likelihood == pytest.approx(here.nearest_voxel_likelihood)
        assert polishing.score(scan, found.T_map_sensor) == here
    assert np.median(after_m) < 0.7 * np.median(before_m)


def test_few_points_approach_the_maximum_and_all_refine_it():
    true = pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
    scan = np.concatenate([scan_at(WORLD, true)] * 2)
    guess = true @ pose(1, 0.5, 0, 0, 0, 0.1)
    polishing = matcher(POLISHING)
    found = polishing.align_once(scan, guess)
    assert found.first.points_in_map <= FIRST_POINTS
    assert found.score == polishing.score(scan, found.T_map_sensor).score
    np.testing.assert_array_equal(found.path[-1], found.T_map_sensor)
    with_all = polishing.align_once(scan[::9], guess)  # too few to be thinned
    assert with_all.first.points_in_map > FIRST_POINTS
    assert errors(found.T_map_sensor, with_all.T_map_sensor)[0] < 0.01
    closer = next(polishing.closer_looks(scan, guess))
    assert closer.first.points_in_map <= FIRST_POINTS
    assert errors(closer.T_map_sensor, found.T_map_sensor)[0] < 0.005  # with fewer points


def test_where_the_map_is_too_sparse_for_finer_voxels_nothing_changes():
    sparse = WORLD[::6]
    true = pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
    scan, guess = scan_at(WORLD, true), pose(40.4, 0.2, 1.9, 0, 0, 0.34)
    found = [matcher(options, sparse).align(scan, guess) for options in (PLAIN, POLISHING)]
    np.testing.assert_array_equal(found[0].T_map_sensor, found[1].T_map_sensor)


def test_wrong_places_are_not_moved_to_better_ones():
    """They score as with ordinary voxels alone, and so are judged alike."""
    world, scan = street_map(), street_scan()[::4]  # so few that all points approach
    plain, polishing = (matcher(replace(one, search="radius"), world) for one in (PLAIN, POLISHING))
    generator = np.random.default_rng(4)
    wrong = 0
    for _ in range(9):
        guess = poses.perturbed(TRUTH, 6.0, 0.3, generator)
        before, after = plain.align_once(scan, guess), polishing.align_once(scan, guess)
        wrong += errors(before.T_map_sensor, TRUTH)[0] > 1.0
        assert errors(after.T_map_sensor, before.T_map_sensor)[0] < 0.3
        np.testing.assert_array_equal(after.path[-1], after.T_map_sensor)
    assert wrong == 2


def test_the_identity_of_autowares_covariance_does_not_widen_finer_voxels():
    as_autoware = matcher(replace(POLISHING, voxel_covariance="autoware"))
    plain = matcher(PLAIN)
    generator = np.random.default_rng(3)
    plain_m, polished_m = [], []
    for x in PLACES_M:
        true = pose(x, 0.5, 1.8, 0.01, -0.02, 0.3)
        scan, guess = scan_at(WORLD, true), poses.perturbed(true, 0.5, 0.05, generator)
        plain_m.append(errors(plain.align(scan, guess).T_map_sensor, true)[0])
        polished_m.append(errors(as_autoware.align(scan, guess).T_map_sensor, true)[0])
    assert np.median(polished_m) < np.median(plain_m)


@pytest.mark.parametrize(
    "changed",
    [{"coarse_levels": ()}, {"regularization_scale_factor": 0.01}],
    ids=["one level", "regularized"],
)
def test_where_nothing_is_polished(changed):
    unpolished = replace(POLISHING, **changed)
    assert unpolished.polishing_levels == ()
    assert VoxelMap.from_points(WORLD, unpolished).polishing == 0


@pytest.mark.parametrize(
    ("regularization", "behaviour", "levels"),
    [(False, "robust", (0.5,)), (True, "robust", ()), (False, "autoware", ())],
)
def test_when_a_node_polishes(regularization, behaviour, levels):
    parameters = replace(MatcherParameters(), regularization=regularization)
    own = replace(OwnParameters(), behaviour=behaviour)
    assert matcher_options(parameters, own).polishing_levels == levels


@pytest.mark.parametrize("levels", [(1.0,), (0.25, 0.5), (0.001,)])
def test_levels_that_are_not_finer(levels):
    with pytest.raises(ManycoreError, match="polish_levels"):
        replace(PLAIN, polish_levels=levels)
