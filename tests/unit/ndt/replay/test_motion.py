# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The motion between scans is estimated from the scans alone, or reported as undetermined."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry.poses import angle_rad, distance_m, from_xyz_rpy
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay import motion
from rmw_manycore_py.ndt.replay.guess_kinds import GuessKind
from rmw_manycore_py.ndt.replay.guess_source import StackInputs
from rmw_manycore_py.ndt.simulation.drive import poses_along, scans_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import build_street

pytestmark = pytest.mark.unit

SEED = 3


def recorded(poses: np.ndarray) -> Recording:
    """Return the scans of a LiDAR at these poses in a street."""
    generator = np.random.default_rng(SEED)
    scans = list(scans_along(build_street(40.0, generator), poses, Lidar(), generator))
    return Recording(scans, poses, np.zeros(0))


def turning() -> np.ndarray:
    """Return poses that turn by up to 50 degrees between scans."""
    turns = np.radians([0.0, 50.0, 10.0, -40.0, 5.0, 55.0])
    poses = poses_along(np.arange(6) * 0.8)
    return np.stack(
        [T @ from_xyz_rpy((0, 0, 0), (0, 0, a)) for T, a in zip(poses, turns, strict=True)]
    )


@pytest.mark.parametrize(
    "poses", [turning(), poses_along(np.arange(4) * 2.5)], ids=["turns", "fast"]
)
def test_it_is_near_the_true_one(poses):
    drive = recorded(poses)
    found = list(motion.of_scans(drive, pytest.fail))
    for true, matched in zip(motion.of_reference(drive), found, strict=True):
        assert distance_m(true, matched) < 0.1
        assert np.degrees(angle_rad(true, matched)) < 1.0


def test_no_pose_is_looked_at():
    drive = recorded(turning()[:3])
    without = Recording(drive.scans, np.tile(np.eye(4), (3, 1, 1)), drive.stamps)
    found = [list(motion.of_scans(each, pytest.fail)) for each in (drive, without)]
    np.testing.assert_array_equal(*found)


def test_scans_of_different_places_do_not_tell_it():
    drive = recorded(poses_along([0.0, 0.8, 30.0, 30.8]))
    doubts: list[str] = []
    found = list(motion.of_scans(drive, doubts.append))
    assert len(doubts) == 1
    assert doubts[0].startswith("from scan 1 to scan 2: ")
    assert found[1] is None
    for told in (found[0], found[2]):
        assert distance_m(told, from_xyz_rpy((0.8, 0.0, 0.0), (0.0, 0.0, 0.0))) < 0.1


def test_the_reference_fills_in_for_the_scans_and_is_reported():
    drive = recorded(poses_along(np.arange(4) * 0.8))
    drive.scans[2] = np.zeros((0, 3), np.float32)
    guesses = GuessKind("odometry", "scans", 0.05, 0.5, 3.0, SEED)
    motions = guesses.motions(drive)
    reference = list(motion.of_reference(drive))
    np.testing.assert_array_equal(motions.between[1:], reference[1:])
    assert not np.array_equal(motions.between[0], reference[0])
    assert "2 of 3 motions the REFERENCE's" in guesses.made_of(motions)
    assert "from scan 1 to scan 2: " in guesses.made_of(motions)


def test_drift_is_a_share_of_the_motion():
    true = from_xyz_rpy((3.0, 0.0, 4.0), (0.0, 0.0, 0.5))
    found = motion.drifted(true, 0.1, np.random.default_rng(SEED))
    assert distance_m(true, found) == pytest.approx(0.5)
    assert angle_rad(true, found) == pytest.approx(0.05)


def test_the_speed_of_a_stack_is_that_along_the_arc():
    """Its filter drives arcs: of a turn by 0.8 rad over a metre, 0.9 m of x would be too slow."""
    sent: list[tuple[float, float]] = []
    arc = from_xyz_rpy((np.sin(0.8) / 0.8, (1.0 - np.cos(0.8)) / 0.8, 0.0), (0.0, 0.0, 0.8))
    inputs = StackInputs(np.eye(4), [arc], np.array([0.5]))
    inputs._publish_twist = lambda _, speed, turn: sent.append((speed, turn))
    inputs.send(0, 0.0, 0)
    assert sent == [pytest.approx((2.0, 1.6))]


@pytest.mark.parametrize(("kind", "count"), [("odometry", 5), ("perturbed", 5), ("velocity", 0)])
def test_guesses_before_the_first_scan_drive_already(kind, count):
    """At the rate that is played; a filter of results alone knows no motion yet."""
    drive = Recording([np.zeros((1, 3), np.float32)] * 3, poses_along([0.0, 0.8, 1.6]), np.zeros(0))
    wanted = GuessKind(kind, "reference", 0.0, 0.0, 0.0, 1)
    source = wanted.source(drive, wanted.motions(drive), rate_hz=20.0)
    sent: dict[int, np.ndarray] = {}
    source._publish_one = lambda stamp_ns, T: sent.update({stamp_ns // 1_000_000: T})
    source.lead_in(10_000_000_000)
    assert len(sent) == count
    if sent:
        source.send(0, 0.0, 10_000_000_000)
        assert sorted(sent) == [9500, 9600, 9700, 9800, 9900, 9999, 10_000]
        assert distance_m(sent[9500], sent[9600]) == pytest.approx(1.6, abs=0.01)
        assert distance_m(sent[9900], sent[10_000]) == pytest.approx(1.6, abs=0.01)
