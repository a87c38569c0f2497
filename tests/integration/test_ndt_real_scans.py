# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Alignments of a recorded drive, or of a simulated one where no recording is installed."""

from __future__ import annotations

import os
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.native.enums import Search, VoxelCovariance
from rmw_manycore_py.ndt import MatcherOptions, SerialMatcher, VoxelMap
from rmw_manycore_py.ndt.geometry.thinning import spread_indices
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import OwnParameters
from rmw_manycore_py.ndt.recordings.recording import load_recording
from support.samples.ndt_world import errors, pose, scan_at, street

pytestmark = pytest.mark.integration

CHECKOUT = Path(__file__).resolve().parents[2]
DATA = Path(os.environ.get("MANYCORE_DATA", CHECKOUT.parent / "shared" / "data"))
DRIVE = DATA / "balm_seq177_v0.10.npz"
DENSE = DATA / "balm_full10.npz"  # ten of its scans, with 73,000 points each


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


@pytest.mark.skipif(
    not (DRIVE.exists() and DENSE.exists()), reason=f"no {DENSE}; set MANYCORE_DATA"
)
def test_the_points_chosen_of_a_large_scan_lead_where_all_lead() -> None:
    sparse, dense = load_recording(DRIVE), load_recording(DENSE)
    most = next(
        field.metadata["default"] for field in fields(OwnParameters) if field.name == "max_matched"
    )
    options = MatcherOptions(search="radius")
    rng = np.random.default_rng(3)
    apart_m = []
    with SerialMatcher(options) as matcher:
        matcher.set_map(VoxelMap.from_points(sparse.accumulated(range(0, len(sparse), 2)), options))
        for index, true in enumerate(dense.poses):
            scan, guess = dense.scan(index), disturbed(true, rng, 1.0, 6.0)
            assert len(scan) > 2 * most
            chosen = scan[spread_indices(len(scan), most)]
            every, few = (matcher.align(points, guess).T_map_sensor for points in (scan, chosen))
            apart_m.append(errors(few, every)[0])
    assert np.median(apart_m) < 0.005
    assert max(apart_m) < 0.02
