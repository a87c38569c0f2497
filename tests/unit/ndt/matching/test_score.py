# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Score and derivatives equal the published formulas, implemented here point by point."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.enums import Search, VoxelCovariance
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry.arrays import scan_points
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from support.samples.ndt_world import Points, pose, scan_at, street

pytestmark = pytest.mark.unit

WORLD = street()
TRUE = (40, 0.5, 1.8, 0.01, -0.02, 0.3)
SCAN = scan_at(WORLD, pose(*TRUE))[::7]

Voxels = dict[tuple[int, ...], tuple[Points, Points]]  # cell: mean, inverse covariance


@cache
def voxels_of(size_m: float, covariance: VoxelCovariance) -> Voxels:
    """Return the voxels of the world."""
    cells, of_point = np.unique(np.floor(WORLD / size_m).astype(int), axis=0, return_inverse=True)
    order, counts = np.argsort(of_point, kind="stable"), np.bincount(of_point.ravel())
    found: Voxels = {}
    for cell, inside in zip(cells, np.split(WORLD[order], np.cumsum(counts)[:-1]), strict=True):
        count = len(inside)
        if count < 6:
            continue
        scatter = np.cov(inside.T) * (count - 1)
        matrix = {
            "pcl": scatter / (count - 1),
            "autoware": (np.eye(3) + scatter) / (count - 1),
            "pclomp": (np.eye(3) + scatter) / count * (count - 1) / count,
        }[covariance]
        values, vectors = np.linalg.eigh(matrix)
        values = np.maximum(values, values[2] / 100)
        found[tuple(cell)] = (inside.mean(axis=0), (vectors / values) @ vectors.T)
    return found


def neighbours(voxels: Voxels, point: Points, size_m: float, search: Search) -> list[Any]:
    if search == "radius":
        means = np.array([mean for mean, _ in voxels.values()])
        near = np.linalg.norm(point - means, axis=1) <= size_m
        return [voxel for voxel, is_near in zip(voxels.values(), near, strict=True) if is_near]
    cell = np.floor(point / size_m).astype(int)
    offsets = [np.zeros(3, int)]
    if search == "direct7":
        offsets += [*np.eye(3, dtype=int), *-np.eye(3, dtype=int)]
    keys = [tuple(cell + offset) for offset in offsets]
    return [voxels[key] for key in keys if key in voxels]


def expected_score(at: Points, options: MatcherOptions) -> tuple[float, float]:
    """Return Magnusson's eq. 6.9 summed, and the mean of each point's best voxel."""
    size = options.voxel_size_m
    c1, c2 = 10 * (1 - options.outlier_ratio), options.outlier_ratio / size**3
    d3 = -np.log(c2)
    d1 = -np.log(c1 + c2) - d3
    d2 = -2 * np.log((-np.log(c1 * np.exp(-0.5) + c2) - d3) / d1)
    voxels = voxels_of(size, options.voxel_covariance)
    total, best = 0.0, []
    for point in SCAN @ at[:3, :3].T + at[:3, 3]:
        scores = [
            -d1 * np.exp(-d2 / 2 * (point - mean) @ inverse @ (point - mean))
            for mean, inverse in neighbours(voxels, point, size, options.search)
        ]
        total += sum(scores)
        best += [max(scores)] if scores else []
    return total, float(np.mean(best))


@pytest.mark.parametrize("covariance", ["pcl", "autoware", "pclomp"])
@pytest.mark.parametrize("search", ["radius", "direct7", "direct1"])
def test_the_score_is_the_published_one(search: Search, covariance: VoxelCovariance) -> None:
    options = MatcherOptions(search=search, voxel_covariance=covariance)
    at = pose(40.2, 0.4, 1.8, 0, 0, 0.31)
    score, nearest = expected_score(at, options)
    with SerialMatcher(options) as matcher:
        matcher.set_map(VoxelMap.from_points(WORLD, options))
        found = matcher.score(SCAN, at)
    assert found.score == pytest.approx(score, rel=1e-5)
    assert found.transform_probability == pytest.approx(score / len(SCAN), rel=1e-5)
    assert found.nearest_voxel_likelihood == pytest.approx(nearest, rel=1e-5)


def central(scan: Points, at: tuple[float, ...], size_m: float) -> Points:
    """Return the points that stay in their voxel under a small change of the pose."""
    matrix = pose(*at)
    place = (scan @ matrix[:3, :3].T + matrix[:3, 3]) / size_m
    inside = np.abs(place - np.floor(place) - 0.5).max(axis=1) < 0.45
    return np.ascontiguousarray(scan[inside])


@pytest.mark.parametrize("angles", [(0.01, -0.02, 0.3), (0.4, -0.7, 2.5), (-1.2, 0.9, -0.4)])
def test_gradient_and_hessian_are_those_of_the_score(angles: tuple[float, float, float]) -> None:
    options = MatcherOptions(polish_levels=(), search="direct1", voxel_covariance="autoware")
    voxel_map = VoxelMap.from_points(WORLD, options)
    native = _ndt.SerialMatcher(match_options(options))
    true = (*TRUE[:3], *angles)
    at = (true[0] + 0.2, true[1] - 0.1, true[2] + 0.1, *(angle + 0.005 for angle in angles))
    scan = scan_points(central(scan_at(WORLD, pose(*true)), at, options.voxel_size_m))

    def evaluate(changed: Any) -> _ndt.Derivatives:
        return native.evaluate(voxel_map.levels, scan, pose(*changed))

    here = evaluate(at)
    step = 1e-3
    gradient, hessian = [], []
    for axis in range(6):
        change = step * np.eye(6)[axis]
        after, before = evaluate(np.add(at, change)), evaluate(np.subtract(at, change))
        gradient.append((after.score - before.score) / (2 * step))
        slopes = (after.gradient - before.gradient) / (2 * step)
        hessian.append(slopes)
    assert here.gradient == pytest.approx(gradient, rel=1e-2, abs=2e-3 * np.abs(gradient).max())
    scale = np.abs(hessian).max()
    assert here.hessian == pytest.approx(np.array(hessian), abs=2e-3 * scale)


def test_regularization_pulls_along_the_vehicle_only() -> None:
    options = MatcherOptions(voxel_covariance="autoware", regularization_scale_factor=0.05)
    true = pose(*TRUE)
    beside = pose(41.0, 3.0, 1.8, 0, 0, 0.3)
    with SerialMatcher(options) as matcher:
        matcher.set_map(VoxelMap.from_points(WORLD, options))
        free = matcher.align(SCAN, true).T_map_sensor
        pulled = matcher.align(SCAN, true, beside).T_map_sensor
    ahead, left = true[:2, 0], true[:2, 1]
    moved = pulled[:2, 3] - free[:2, 3]
    assert moved @ ahead > 0.05
    assert abs(moved @ left) < abs(moved @ ahead) / 4


@pytest.mark.parametrize("search", ["radius", "direct7", "direct1"])
def test_scores_of_points_are_the_likelihood_of_the_nearest_voxels(search):
    options = replace(MatcherOptions(), search=search, coarse_levels=())
    matcher = SerialMatcher(options)
    matcher.set_map(VoxelMap.from_points(WORLD, options))
    scan = np.concatenate([SCAN, np.float32([[np.nan, 0, 0], [1e4, 0, 0]])])
    scores = matcher.point_scores(scan, pose(*TRUE))
    score = matcher.score(scan, pose(*TRUE))
    seen = scores[np.isfinite(scores)]
    assert np.isnan(scores[-2:]).all()
    assert len(seen) == score.points_in_map
    assert seen.mean() == pytest.approx(score.nearest_voxel_likelihood, rel=1e-5)


def test_an_alignment_has_its_path_and_initial_score():
    options = replace(MatcherOptions(), coarse_levels=())
    matcher = SerialMatcher(options)
    matcher.set_map(VoxelMap.from_points(WORLD, options))
    guess = pose(40.3, 0.4, 1.8, 0.01, -0.02, 0.32)
    found = matcher.align(SCAN, guess)
    assert len(found.path) == 1 + found.iterations
    np.testing.assert_allclose(found.path[0], guess, atol=1e-12)
    np.testing.assert_array_equal(found.path[-1], found.T_map_sensor)
    assert found.first == matcher.score(SCAN, guess)
    assert found.score > found.first.score
    steep = np.eye(4)
    steep[:3, :3] = [[0, 0, -1], [0, 1, 0], [1, 0, 0]]  # tilted upwards: aligned in a level frame
    turned = matcher.align(SCAN @ steep[:3, :3], guess @ steep)
    np.testing.assert_allclose(turned.path[0], guess @ steep, atol=1e-9)
    np.testing.assert_allclose(turned.path[-1], turned.T_map_sensor, atol=1e-9)
