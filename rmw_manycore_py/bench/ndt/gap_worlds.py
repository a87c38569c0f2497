# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Worlds in which a scan seldom tells where the vehicle is: along the way, or at all."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.simulation.drive import poses_along, scans_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street, build_street

LIDAR = Lidar(rings=32, azimuths=400)
BEYOND_M = 60.0  # that walls go on beyond the ends
HALF_STREET_M, HALF_TUNNEL_M = 7.0, 4.5
STREET_M = 60.0  # of street before and after a tunnel
RAILS_M, POSTS_EVERY_M = 6.0, 50.0  # of a motorway, beside its middle and along it
POSTS, SQUARE_M = 10, 120.0


def street_of_few_features(length_m: float, seed: int) -> Street:
    """Return two plain walls with a buttress every 6 to 14 m."""
    generator = np.random.default_rng(seed)
    half, end = HALF_STREET_M, length_m + BEYOND_M
    lower = [[-BEYOND_M, -half - 8.0, 0.0], [-BEYOND_M, half, 0.0]]
    upper = [[end, -half, 6.0], [end, half + 8.0, 6.0]]
    x = -40.0
    while x < length_m + 40.0:
        side, depth = generator.choice([-1.0, 1.0]), generator.uniform(0.5, 1.2)
        near, far = sorted((side * half, side * (half - depth)))
        lower.append([x, near, 0.0])
        upper.append([x + generator.uniform(0.8, 2.0), far, generator.uniform(2.0, 5.0)])
        x += generator.uniform(6.0, 14.0)
    return Street(np.array(lower), np.array(upper), np.zeros((0, 2)), np.zeros(0), np.zeros(0))


def bare_tunnel(length_m: float) -> Street:
    """Return a tunnel without features from x = 60 m on, between two streets."""
    before = build_street(STREET_M, np.random.default_rng(3))
    after = build_street(STREET_M, np.random.default_rng(4))
    end, half = STREET_M + length_m, HALF_TUNNEL_M
    lower = [[STREET_M, -half - 1.0, 0.0], [STREET_M, half, 0.0], [STREET_M, -half, 5.0]]
    upper = [[end, -half, 5.0], [end, half + 1.0, 5.0], [end, half, 6.0]]
    here, there = before.upper[:, 0] < STREET_M, after.lower[:, 0] > 0.0
    near, far = before.centres[:, 0] < STREET_M, after.centres[:, 0] > 0.0
    shift = np.array([end, 0.0, 0.0])
    return Street(
        np.concatenate([before.lower[here], lower, after.lower[there] + shift]),
        np.concatenate([before.upper[here], upper, after.upper[there] + shift]),
        np.concatenate([before.centres[near], after.centres[far] + shift[:2]]),
        np.concatenate([before.radii[near], after.radii[far]]),
        np.concatenate([before.heights[near], after.heights[far]]),
    )


def motorway(length_m: float, seed: int) -> Street:
    """Return guard rails, posts, and a gantry every 60 to 150 m."""
    generator = np.random.default_rng(seed)
    start, end = -BEYOND_M, length_m + BEYOND_M
    boxes = [(start, y, 0.5, end, y + 0.05, 0.8) for y in (-RAILS_M, RAILS_M)]
    x = generator.uniform(0.0, 60.0)
    while x < length_m:
        boxes.append((x, -9.0, 6.0, x + 0.3, 9.0, 7.0))
        boxes += [(x, y, 0.0, x + 0.3, y + 0.3, 7.0) for y in (-9.0, 9.0)]
        x += generator.uniform(60.0, 150.0)
    along = np.arange(start, end, POSTS_EVERY_M)
    posts = np.array([(x, side * (RAILS_M + 2.0)) for x in along for side in (-1.0, 1.0)])
    corners = np.array(boxes).reshape(-1, 2, 3)
    radii, heights = np.full(len(posts), 0.06), np.full(len(posts), 1.0)
    return Street(corners[:, 0], corners[:, 1], posts, radii, heights)


def open_square(seed: int) -> Street:
    """Return some posts on level ground, and a kiosk."""
    generator = np.random.default_rng(seed)
    centres = generator.uniform((0.0, -0.5 * SQUARE_M), (SQUARE_M, 0.5 * SQUARE_M), (POSTS, 2))
    lower, upper = np.array([[62.0, 12.0, 0.0]]), np.array([[63.5, 13.5, 3.0]])
    return Street(lower, upper, centres, np.full(POSTS, 0.12), np.full(POSTS, 5.0))


def map_of(street: Street, length_m: float) -> Points:
    """Return the points of a drive on the other lane."""
    places = poses_along(np.arange(-8.0, length_m + 8.0, 4.0), side_m=0.6)
    scans = scans_along(street, places, LIDAR, np.random.default_rng(9))
    points = [poses.transform(T, scan) for T, scan in zip(places, scans, strict=True)]
    return np.concatenate(points).astype(np.float32)
