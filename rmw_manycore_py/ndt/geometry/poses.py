# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rigid transforms as 4x4 matrices; T_a_b maps points of frame b to frame a. Metres, radians.

Quaternions are [x, y, z, w] as in ROS messages; roll, pitch and yaw are rotations about the fixed
axes x, y, z in that order (REP 103).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rmw_manycore_py.ndt.geometry.arrays import Matrix


def transform(T_a_b: Matrix, points_b: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return points (N, 3) in frame a, with the dtype of the input."""
    moved: Matrix = points_b @ T_a_b[:3, :3].T + T_a_b[:3, 3]
    return moved.astype(points_b.dtype, copy=False)


def inverse(T_a_b: Matrix) -> Matrix:
    """Return T_b_a."""
    T_b_a = np.eye(4)
    T_b_a[:3, :3] = T_a_b[:3, :3].T
    T_b_a[:3, 3] = -T_a_b[:3, :3].T @ T_a_b[:3, 3]
    return T_b_a


def from_xyz_rpy(xyz_m: npt.ArrayLike, rpy_rad: npt.ArrayLike = (0.0, 0.0, 0.0)) -> Matrix:
    """Return the transform (4, 4) of a position and roll, pitch, yaw."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy_rad), np.sin(rpy_rad)
    T = np.eye(4)
    T[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    T[:3, 3] = xyz_m
    return T


def to_rpy(T: Matrix) -> Matrix:
    """Return roll, pitch, yaw (3)."""
    pitch = np.arctan2(-T[2, 0], np.hypot(T[0, 0], T[1, 0]))
    return np.array([np.arctan2(T[2, 1], T[2, 2]), pitch, np.arctan2(T[1, 0], T[0, 0])])


def rotation_vector(R: Matrix) -> Matrix:
    """Return the rotation vector (axis times angle) of a rotation matrix (3, 3)."""
    x, y, z, w = to_quaternion(R)
    sine = np.sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return np.zeros(3)
    vector: Matrix = np.array([x, y, z]) * (2.0 * np.arctan2(sine, w) / sine)
    return vector


def from_rotation_vector(vector_rad: npt.ArrayLike) -> Matrix:
    """Return the rotation matrix (3, 3) of a rotation vector (Rodrigues)."""
    vector = np.asarray(vector_rad, dtype=np.float64)
    angle = float(np.linalg.norm(vector))
    if angle < 1e-12:
        return np.eye(3)
    K = cross_matrix(vector / angle)
    R: Matrix = np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K)
    return R


def cross_matrix(axis: Matrix) -> Matrix:
    """Return K (3, 3) for which K @ p is the cross product of an axis (3,) and p."""
    x, y, z = axis
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def to_quaternion(R: Matrix) -> Matrix:
    """Return the quaternion of a rotation matrix (3, 3), with w >= 0 (Shepperd's method)."""
    m = R[:3, :3]
    squares = np.array(
        [
            1.0 + m[0, 0] - m[1, 1] - m[2, 2],
            1.0 - m[0, 0] + m[1, 1] - m[2, 2],
            1.0 - m[0, 0] - m[1, 1] + m[2, 2],
            1.0 + np.trace(m),
        ]
    )
    products = np.array(
        [
            [0.0, m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
            [m[0, 1] + m[1, 0], 0.0, m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
            [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], 0.0, m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 0.0],
        ]
    )
    largest = int(np.argmax(squares))
    quaternion: Matrix = products[largest] + np.eye(4)[largest] * squares[largest]
    quaternion /= np.linalg.norm(quaternion)
    return -quaternion if quaternion[3] < 0.0 else quaternion


def from_quaternion(quaternion: npt.ArrayLike) -> Matrix:
    """Return the rotation matrix (3, 3) of a quaternion, normalised first; it must not be zero."""
    x, y, z, w = np.asarray(quaternion, dtype=np.float64) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def velocities(motion: Matrix) -> tuple[Matrix, Matrix]:
    """Return the body twist (v, w), each (3,), that makes a motion (4, 4) in unit time.

    The logarithm of SE(3), v = J(w)^-1 t: Barfoot, State Estimation for Robotics, ch. 7.
    """
    w = rotation_vector(motion[:3, :3])
    t = motion[:3, 3]
    half = 0.5 * float(np.linalg.norm(w))
    if half < 1e-12:
        return t.copy(), w
    axis = 0.5 * w / half
    along = float(axis @ t) * axis
    v: Matrix = along + half / np.tan(half) * (t - along) - half * np.cross(axis, t)
    return v, w


def travelled(v: Matrix, w: Matrix, shares: Matrix) -> Matrix:
    """Return where constant body velocities have led after shares (N) of unit time: (N, 3).

    The translation of SE(3)'s exponential, s J(s w) v: an arc of a helix.
    """
    s = shares[:, None]
    angle = float(np.linalg.norm(w))
    if angle < 1e-12:
        return s * v
    axis = w / angle
    along: Matrix = float(axis @ v) * axis
    sine, versine = np.sin(s * angle), 2.0 * np.square(np.sin(0.5 * s * angle))
    where: Matrix = s * along + (sine * (v - along) + versine * np.cross(axis, v)) / angle
    return where


def part_of_motion(motion: Matrix, share: float) -> Matrix:
    """Return a share of a motion (4, 4) with constant body velocities; extrapolated beyond 0, 1."""
    v, w = velocities(motion)
    T = np.eye(4)
    T[:3, :3] = from_rotation_vector(share * w)
    T[:3, 3] = travelled(v, w, np.array([share]))[0]
    return T


def interpolate(T_old: Matrix, T_new: Matrix, share: float) -> Matrix:
    """Interpolate between two poses, share 0 to 1, with constant body velocities."""
    T: Matrix = T_old @ part_of_motion(inverse(T_old) @ T_new, share)
    return T


def interpolate_on_chord(T_old: Matrix, T_new: Matrix, share: float) -> Matrix:
    """Interpolate as Autoware does: positions on the chord, whatever the vehicle's turn."""
    T = interpolate(T_old, T_new, share)
    T[:3, 3] = (1.0 - share) * T_old[:3, 3] + share * T_new[:3, 3]
    return T


ROTATION_TOLERANCE = 0.01


def rigid(matrices: npt.NDArray[Any]) -> Matrix:
    """Return (S, 4, 4) or (S, 3, 4) as rigid transforms, with rounding errors removed.

    :raises ValueError: if one is not finite or far from rigid; names its index.
    """
    T = np.tile(np.eye(4), (len(matrices), 1, 1))
    T[:, :3] = matrices[:, :3]
    if not np.isfinite(T).all():
        first = int(np.flatnonzero(~np.isfinite(T).all(axis=(1, 2)))[0])
        raise ValueError(f"pose {first} is not finite")
    U, _, V = np.linalg.svd(T[:, :3, :3])
    R = U @ V
    is_far = (np.abs(R - T[:, :3, :3]).max(axis=(1, 2)) > ROTATION_TOLERANCE) | (
        np.linalg.det(R) < 0
    )
    if is_far.any():
        raise ValueError(f"pose {int(np.flatnonzero(is_far)[0])} holds no rotation")
    T[:, :3, :3] = R
    return T


def distance_m(T_a: Matrix, T_b: Matrix) -> float:
    """Return the distance between two positions."""
    return float(np.linalg.norm(T_a[:3, 3] - T_b[:3, 3]))


def angle_rad(T_a: Matrix, T_b: Matrix) -> float:
    """Return the angle between two orientations."""
    return float(np.linalg.norm(rotation_vector(T_a[:3, :3].T @ T_b[:3, :3])))


def perturbed(
    T: Matrix,
    offset_m: float,
    turn_rad: float,
    generator: np.random.Generator,
) -> Matrix:
    """Return a pose moved and turned by the given amounts, each in a random direction."""
    T_new: Matrix = T.copy()
    T_new[:3, 3] += offset_m * _direction(generator)
    T_new[:3, :3] = T[:3, :3] @ from_rotation_vector(turn_rad * _direction(generator))
    return T_new


def _direction(generator: np.random.Generator) -> Matrix:
    vector: Matrix = generator.normal(size=3)
    vector /= np.linalg.norm(vector)
    return vector
