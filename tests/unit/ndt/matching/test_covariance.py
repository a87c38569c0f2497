# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Covariances from several alignments or scores, in a street with corners and in a tunnel."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt import Alignment, MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.matching.options import PoseCovariance
from support.samples.ndt_world import Points, pose, scan_at, street

pytestmark = pytest.mark.unit

TRUE = pose(40, 0.5, 1.8, 0, 0, 0.3)
OPTIONS = MatcherOptions()


def tunnel() -> Points:
    """Return ground and two endless walls along x."""
    rng = np.random.default_rng(3)
    along, across = rng.uniform(0, 80, 60_000), rng.uniform(-6, 6, 60_000)
    ground = np.stack([along, across, np.zeros(60_000)], axis=1)
    walls = np.stack([along, np.sign(across) * 6, np.abs(across)], axis=1)
    return np.concatenate([ground, walls]) + rng.normal(scale=0.02, size=(120_000, 3))


def aligned(world: Points, true: Points = TRUE, **options: Any) -> Alignment:
    chosen = MatcherOptions(**options)
    with SerialMatcher(chosen) as matcher:
        matcher.set_map(VoxelMap.from_points(world, chosen))
        return matcher.align(scan_at(world, true), true @ pose(0.2, 0.1, 0, 0, 0, 0.01))


def deviations(found: Alignment) -> tuple[float, float]:
    """Return the standard deviations along and across the street."""
    return float(np.sqrt(found.covariance[0, 0])), float(np.sqrt(found.covariance[1, 1]))


@pytest.mark.parametrize("kind", ["multi_ndt", "multi_ndt_score"])
def test_a_tunnel_leaves_its_direction_unknown(kind: PoseCovariance) -> None:
    ahead = pose(40, 0.5, 1.8, 0, 0, 0)
    along_street, across_street = deviations(aligned(street(), ahead, pose_covariance=kind))
    along_tunnel, across_tunnel = deviations(aligned(tunnel(), ahead, pose_covariance=kind))
    assert along_tunnel > 0.2
    assert max(along_street, across_street, across_tunnel) < along_tunnel / 3


def test_alignments_from_around_scatter_as_defined() -> None:
    found = aligned(street(), pose_covariance="multi_ndt")
    plain = replace(OPTIONS, polish_levels=())  # finer voxels know less of the surroundings
    with SerialMatcher(plain) as matcher:
        matcher.set_map(VoxelMap.from_points(street(), plain))
        places = [found.T_map_sensor[:2, 3]]
        for ahead, left in OPTIONS.offsets_m:
            beside = found.T_map_sensor @ pose(ahead, left, 0, 0, 0, 0)
            beside[2, 3] = found.T_map_sensor[2, 3]
            places.append(matcher.align(scan_at(street(), TRUE), beside).T_map_sensor[:2, 3])
    expected = np.cov(np.array(places).T, bias=True) * 6 / 7
    assert found.covariance[:2, :2] == pytest.approx(expected, rel=1e-3, abs=1e-7)
    assert np.diag(found.covariance)[2:].tolist() == list(OPTIONS.fixed_pose_variances)[2:]
    reached = np.array([T[:2, 3] for T in found.results_around])
    assert reached == pytest.approx(np.array(places[1:]), abs=1e-4)


def test_likelihoods_around_weigh_as_defined() -> None:
    offsets_m = ((0.4, 0.0), (0.0, 0.8))
    found = aligned(
        street(), pose_covariance="multi_ndt_score", offsets_m=offsets_m, temperature=1.0
    )
    with SerialMatcher(OPTIONS) as matcher:
        matcher.set_map(VoxelMap.from_points(street(), OPTIONS))
        poses = [found.T_map_sensor]
        for offset in offsets_m:
            beside = found.T_map_sensor.copy()
            beside[:2, 3] += found.T_map_sensor[:2, :2] @ offset
            poses.append(beside)
        scan = scan_at(street(), TRUE)
        weights = np.exp([matcher.score(scan, T).nearest_voxel_likelihood for T in poses])
    expected = np.cov(np.array([T[:2, 3] for T in poses]).T, bias=True, aweights=weights)
    assert found.covariance[:2, :2] == pytest.approx(expected, rel=1e-6)
    assert np.array(found.guesses_around) == pytest.approx(np.array(poses[1:]))
    assert found.results_around == ()


def test_what_did_not_converge_has_the_fixed_covariance() -> None:
    options = MatcherOptions(pose_covariance="multi_ndt")
    with SerialMatcher(options) as matcher:
        matcher.set_map(VoxelMap.from_points(street(), options))
        found = matcher.align(scan_at(street(), TRUE), pose(1e6, 0, 0, 0, 0, 0))
    assert not found.converged
    assert np.diag(found.covariance).tolist() == list(options.fixed_pose_variances)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("offsets_m", ()),
        ("offsets_m", ((1.0,),)),
        ("offsets_m", ((1.0, np.nan),)),
        ("temperature", 0.0),
        ("pose_covariance", "guessed"),
    ],
)
def test_what_covariances_are_made_of_is_checked(name: str, value: Any) -> None:
    with pytest.raises(ManycoreError, match=f"{name}: expected .* found"):
        MatcherOptions(**{name: value})
