# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rigid transforms, checked by properties that hold for every pose."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry import poses

pytestmark = pytest.mark.unit


def some_poses() -> list[np.ndarray]:
    generator = np.random.default_rng(4)
    random = [
        poses.from_xyz_rpy(generator.normal(size=3), generator.uniform(-3, 3, 3)) for _ in range(20)
    ]
    half_turns = [poses.from_xyz_rpy((0, 0, 0), np.pi * np.eye(3)[axis]) for axis in range(3)]
    return [np.eye(4), *half_turns, *random]


@pytest.mark.parametrize("T", some_poses())
def test_there_and_back(T):
    rotation = T[:3, :3]
    np.testing.assert_allclose(poses.inverse(T) @ T, np.eye(4), atol=1e-12)
    np.testing.assert_allclose(
        poses.from_quaternion(poses.to_quaternion(rotation)), rotation, atol=1e-12
    )
    np.testing.assert_allclose(
        poses.from_rotation_vector(poses.rotation_vector(rotation)), rotation, atol=1e-9
    )
    np.testing.assert_allclose(poses.from_xyz_rpy(T[:3, 3], poses.to_rpy(T)), T, atol=1e-9)


def test_frames():
    T_map_sensor = poses.from_xyz_rpy((10.0, 0.0, 2.0), (0.0, 0.0, np.pi / 2))
    ahead = np.array([[1.0, 0.0, 0.0]], np.float32)
    moved = poses.transform(T_map_sensor, ahead)
    assert moved.dtype == np.float32
    np.testing.assert_allclose(moved, [[10.0, 1.0, 2.0]], atol=1e-6)


def test_interpolation_ends_and_middle():
    """A vehicle that turns by one radian over two metres of a circle."""
    old = np.eye(4)
    for share in (0.0, 0.5, 1.0):
        place = (2.0 * np.sin(share), 2.0 * (1.0 - np.cos(share)), 0.0)
        expected = poses.from_xyz_rpy(place, (0.0, 0.0, share))
        new = poses.from_xyz_rpy((2.0 * np.sin(1.0), 2.0 * (1.0 - np.cos(1.0)), 0.0), (0, 0, 1.0))
        np.testing.assert_allclose(poses.interpolate(old, new, share), expected, atol=1e-12)


@pytest.mark.parametrize("T", some_poses())
def test_parts_of_a_motion_add_up(T):
    third = poses.part_of_motion(T, 1.0 / 3.0)
    np.testing.assert_allclose(third @ third @ third, T, atol=1e-7)
    beyond = poses.part_of_motion(T, 4.0 / 3.0)
    np.testing.assert_allclose(beyond, T @ third, atol=1e-7)


def test_interpolation_as_in_autoware_is_on_the_chord():
    old, new = np.eye(4), poses.from_xyz_rpy((2.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    expected = poses.from_xyz_rpy((0.5, 0.25, 0.0), (0.0, 0.0, 0.25))
    found = poses.interpolate_on_chord(old, new, 0.25)
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_perturbation_has_its_size():
    generator = np.random.default_rng(0)
    T = poses.from_xyz_rpy((5.0, 1.0, 0.0), (0.1, 0.2, 2.0))
    other = poses.perturbed(T, 0.5, 0.05, generator)
    assert poses.distance_m(T, other) == pytest.approx(0.5)
    assert poses.angle_rad(T, other) == pytest.approx(0.05)
