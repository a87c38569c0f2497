# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Guesses: the pose a scan is matched from, and the reasons to refuse one."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.nodes.scan_matcher.guesses import Guesses
from rmw_manycore_py.ndt.nodes.scan_matcher.pose_buffer import NoPoseError, PoseBuffer

pytestmark = pytest.mark.unit

SPEED_M_S, TURN_RAD_S = 15.0, 0.3


def at(x: float, yaw: float = 0.0) -> np.ndarray:
    return poses.from_xyz_rpy((x, 0.0, 0.0), (0.0, 0.0, yaw))


def on_a_circle(stamp_s: float) -> np.ndarray:
    angle = TURN_RAD_S * stamp_s
    radius_m = SPEED_M_S / TURN_RAD_S
    place = (radius_m * np.sin(angle), radius_m * (1.0 - np.cos(angle)), 0.0)
    return poses.from_xyz_rpy(place, (0.0, 0.0, angle))


def driven(*stamps_s: float, newest_holds: bool = False) -> Guesses:
    """Return the guesses of a drive at these times, after scans every 0.1 s."""
    guesses = Guesses(1.0, 10.0, newest_holds)
    for scan in range(10):
        guesses.note_scan(0.1 * scan)
    for stamp_s in stamps_s:
        guesses.push(stamp_s, on_a_circle(stamp_s))
    return guesses


def test_the_motion_is_seen_over_several_periods():
    """So a jump of one guess counts little; without guesses so old it is that since the oldest."""
    stamps_s = [i / 10 for i in range(11)]
    found = driven(*stamps_s).motion_until(1.0, on_a_circle(1.0))
    assert found is not None
    motion, duration_s = found
    assert duration_s == pytest.approx(0.4)
    np.testing.assert_allclose(on_a_circle(0.6) @ motion, on_a_circle(1.0), atol=1e-9)
    motion, duration_s = driven(0.9, 1.0).motion_until(1.0, on_a_circle(1.0))
    assert duration_s == pytest.approx(0.1)
    assert driven(0.98, 1.0).motion_until(1.0, on_a_circle(1.0)) is None
    assert driven(1.0).motion_until(5.0, on_a_circle(5.0)) is None


def test_guesses_more_than_a_second_old_do_not_tell_the_motion():
    """Nor do they hide those that came since, as after a pause."""
    guesses = driven(0.0, 1.1, 1.2)
    assert guesses.motion_until(1.1, on_a_circle(1.1)) is None
    motion, duration_s = guesses.motion_until(1.2, on_a_circle(1.2))
    assert duration_s == pytest.approx(0.1)
    np.testing.assert_allclose(on_a_circle(1.1) @ motion, on_a_circle(1.2), atol=1e-9)


def test_a_jump_of_the_guesses_is_no_motion():
    """A new first pose 20 m ahead: from there on the motion is known again after a scan."""
    guesses = driven(*(0.1 * k for k in range(11)))
    ahead = poses.from_xyz_rpy((20.0, 0.0, 0.0))
    for stamp_s in (1.1, 1.2):
        guesses.push(stamp_s, ahead @ on_a_circle(stamp_s))
    assert guesses.motion_until(1.1, ahead @ on_a_circle(1.1)) is None
    motion, duration_s = guesses.motion_until(1.2, ahead @ on_a_circle(1.2))
    assert duration_s == pytest.approx(0.1)
    np.testing.assert_allclose(on_a_circle(1.1) @ motion, on_a_circle(1.2), atol=1e-9)


def test_autoware_rule_holds_the_newest_pose():
    buffer = PoseBuffer(1.0, 10.0)
    buffer.push(1.0, at(0.0))
    assert buffer.newest_at(1.0) is None
    buffer.push(2.0, at(2.0))
    assert buffer.newest_at(1.25).T[0, 3] == pytest.approx(0.5)
    assert buffer.newest_at(2.5).T[0, 3] == pytest.approx(2.0)
    assert buffer.newest_at(0.9) is None
    assert buffer.newest_at(3.1) is None


def test_autoware_rule_refuses_jumps_and_forgets():
    buffer = PoseBuffer(1.0, 10.0)
    for stamp_s, x in ((1.0, 0.0), (1.5, 50.0), (2.0, 51.0)):
        buffer.push(stamp_s, at(x))
    assert buffer.newest_at(1.2) is None
    assert buffer.newest_at(1.7) is not None
    buffer.forget_before(1.9)
    assert buffer.newest_at(1.2) is None
    buffer.push(0.5, at(0.0))
    assert buffer.newest_at(1.7) is None


def test_autoware_behaviour_takes_a_guess_almost_a_second_old():
    guesses = driven(0.8, 0.9, newest_holds=True)
    assert guesses.is_there(1.8)
    np.testing.assert_array_equal(guesses.at(1.8).T, on_a_circle(0.9))


def test_a_guess_of_the_stamp_of_the_scan_is_taken_as_it_is():
    guesses = driven(1.0)
    assert guesses.is_there(1.0)
    guess = guesses.at(1.0)
    np.testing.assert_array_equal(guess.T, on_a_circle(1.0))
    assert guess.age_s == 0.0


def test_a_guess_between_two_is_interpolated():
    guess = driven(0.9, 1.0).at(0.96)
    np.testing.assert_allclose(guess.T, on_a_circle(0.96), atol=1e-9)


def test_autoware_behaviour_interpolates_on_the_chord():
    old, new = on_a_circle(0.9), on_a_circle(1.0)
    found = driven(0.9, 1.0, newest_holds=True).at(0.96).T
    np.testing.assert_allclose(found[:3, 3], 0.4 * old[:3, 3] + 0.6 * new[:3, 3], atol=1e-9)


def test_a_guess_is_moved_on_along_the_arc():
    guess = driven(0.8, 0.9, 1.0).at(1.1)
    np.testing.assert_allclose(guess.T, on_a_circle(1.1), atol=1e-9)


@pytest.mark.parametrize("age_s", [0.001, 0.05, 0.1, 0.14])
def test_an_older_guess_is_moved_on(age_s):
    """Also if two guesses of the same pose are sent for a scan: alone they contain no motion."""
    guesses = driven(*(0.1 * k for k in range(11)))
    guesses.push(1.001, on_a_circle(1.0))
    scan_s = 1.001 + age_s
    assert not guesses.is_there(scan_s)
    guess = guesses.at(scan_s)
    assert guess.age_s == pytest.approx(age_s)
    assert poses.distance_m(guess.T, on_a_circle(scan_s)) < 0.04
    assert poses.angle_rad(guess.T, on_a_circle(scan_s)) < 0.002


def test_a_guess_older_than_one_and_a_half_periods_is_refused():
    with pytest.raises(NoPoseError, match=r"0\.160 s older, more than 0\.150 s"):
        driven(0.8, 0.9, 1.0).at(1.16)


def test_the_period_of_the_scans_bounds_the_age():
    guesses = driven(0.6, 0.8, 1.0)
    for scan in range(10):
        guesses.note_scan(1.0 + 0.5 * scan)
    assert guesses.at(1.16).age_s == pytest.approx(0.16)


def test_a_first_guess_holds_only_for_a_moment():
    assert driven(1.0).at(1.015).age_s == pytest.approx(0.015)
    with pytest.raises(NoPoseError, match="no pose before it determines the motion"):
        driven(1.0).at(1.05)


def test_a_jump_gives_no_motion():
    guesses = driven(0.9)
    guesses.push(1.0, at(80.0))
    with pytest.raises(NoPoseError, match="m from the one before it"):
        guesses.at(1.05)


def test_without_guesses_or_with_newer_ones_only():
    with pytest.raises(NoPoseError, match="no pose has arrived"):
        driven().at(1.0)
    with pytest.raises(NoPoseError, match=r"the oldest pose is 0\.500 s newer"):
        driven(1.5, 1.6).at(1.0)
    guesses = driven(1.0)
    guesses.clear()
    assert not guesses.is_there(1.0)
