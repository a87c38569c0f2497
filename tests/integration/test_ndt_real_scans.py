# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Alignments of a recorded drive; of a simulated one where there are no recordings."""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ndt_world import errors, pose, scan_at, street

from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.words import Search, VoxelCovariance

pytestmark = pytest.mark.integration

CHECKOUT = Path(__file__).resolve().parents[2]
DATA = Path(os.environ.get("MANYCORE_DATA", CHECKOUT.parent / "shared" / "data"))
DRIVE = DATA / "balm_seq177_v0.10.npz"


def recorded() -> tuple[list[Any], Any]:
    data = np.load(DRIVE)
    points = data["points"] * float(data["scale_m"])
    offsets = data["offsets"]
    scans = [points[begin:end] for begin, end in pairwise(offsets)]
    return scans, data["poses"]


def simulated() -> tuple[list[Any], Any]:
    world = street()
    poses = np.array([pose(20 + 0.4 * i, 0.5, 1.8, 0, 0, 0.02 * i) for i in range(60)])
    return [scan_at(world, at) for at in poses], poses


@pytest.fixture(scope="module")
def drive() -> tuple[list[Any], Any]:
    return recorded() if DRIVE.exists() else simulated()


def disturbed(true: Any, rng: np.random.Generator, distance_m: float, angle_deg: float) -> Any:
    shift = rng.normal(size=3)
    turn = rng.normal(size=3)
    turn *= np.radians(angle_deg) / np.linalg.norm(turn)
    guess = true @ pose(0, 0, 0, *turn)
    guess[:3, 3] += shift * distance_m / np.linalg.norm(shift)
    return guess


@pytest.mark.parametrize(
    ("search", "covariance"), [("direct7", "autoware"), ("radius", "pcl")], ids=str
)
@pytest.mark.parametrize(
    ("distance_m", "angle_deg", "share"), [(0.5, 3, 0.99), (1.0, 6, 0.95)], ids=str
)
def test_scans_are_found_from_disturbed_guesses(
    drive: tuple[list[Any], Any],
    search: Search,
    covariance: VoxelCovariance,
    distance_m: float,
    angle_deg: float,
    share: float,
) -> None:
    scans, poses = drive
    options = MatcherOptions(search=search, voxel_covariance=covariance)
    even = [
        scan @ at[:3, :3].T + at[:3, 3] for scan, at in zip(scans[::2], poses[::2], strict=True)
    ]
    rng = np.random.default_rng(3)
    found = []
    with SerialMatcher(options) as matcher:
        matcher.set_map(VoxelMap.from_points(np.concatenate(even), options))
        for scan, true in zip(scans[1::2], poses[1::2], strict=True):
            guess = disturbed(true, rng, distance_m, angle_deg)
            found.append(errors(matcher.align(scan, guess).T_map_sensor, true))
    good = [distance < 0.2 and angle < 1.0 for distance, angle in found]
    assert np.mean(good) >= share
    assert np.median([distance for distance, _ in found]) <= 0.03
