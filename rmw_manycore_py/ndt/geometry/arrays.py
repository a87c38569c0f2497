# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Array types of points and poses, and conversions for the kernel."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

Points: TypeAlias = NDArray[np.floating[Any]]  # (N, 3); single precision, or double (precision.py)
ScanPoints: TypeAlias = NDArray[np.float32]  # (N, 3)
Matrix: TypeAlias = NDArray[np.float64]  # of any shape
Pose: TypeAlias = NDArray[np.float64]  # (4, 4)
Poses: TypeAlias = NDArray[np.float64]  # (S, 4, 4)
Matrix6: TypeAlias = NDArray[np.float64]  # (6, 6)

ROTATION_TOLERANCE = 1e-3
FARTHEST_M = 1e9


def scan_points(points: ArrayLike) -> ScanPoints:
    """Return points (N, 3) as a contiguous float32 array."""
    return np.ascontiguousarray(_of_three_columns(points), dtype=np.float32)


def map_points(points: ArrayLike) -> Matrix:
    """Return points (N, 3) as a contiguous float64 array."""
    return np.ascontiguousarray(_of_three_columns(points), dtype=np.float64)


def pose_matrix(pose: ArrayLike) -> Pose:
    """Return a transform as a contiguous (4, 4) array; the values are not checked."""
    matrix = np.ascontiguousarray(real_numbers("pose", pose, "(4, 4)"), dtype=np.float64)
    if matrix.shape != (4, 4):
        raise ManycoreError(f"pose: expected shape (4, 4), found {matrix.shape}", EXIT_BAD_INPUT)
    return matrix


def pose_error(matrix: Pose) -> str:
    """Return why a (4, 4) matrix is not a valid pose; "" if it is."""
    if not np.isfinite(matrix).all():
        return "is not finite"
    if np.abs(matrix[:3, 3]).max() > FARTHEST_M:
        return f"is more than {FARTHEST_M:g} m from the map's origin"
    rotation = matrix[:3, :3]
    is_rotation = np.abs(rotation @ rotation.T - np.eye(3)).max() < ROTATION_TOLERANCE
    if not is_rotation or np.linalg.det(rotation) < 0:
        return "holds no rotation"
    return ""


def real_numbers(name: str, value: ArrayLike, shape: str) -> NDArray[Any]:
    """Return an array; raise ManycoreError unless its elements are real numbers.

    numpy would also accept strings and complex numbers. The shape is only named in the error.
    """
    expected = f"{name}: expected real numbers of shape {shape}"
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ManycoreError(
            f"{expected}, found rows of different lengths", EXIT_BAD_INPUT
        ) from error
    if array.dtype.kind not in "fiu":
        raise ManycoreError(f"{expected}, found elements of {array.dtype}", EXIT_BAD_INPUT)
    return array


def _of_three_columns(points: ArrayLike) -> Points:
    array = real_numbers("points", points, "(N, 3)")
    if array.size == 0:
        return np.zeros((0, 3))
    if array.ndim != 2 or array.shape[1] != 3:
        raise ManycoreError(f"points: expected shape (N, 3), found {array.shape}", EXIT_BAD_INPUT)
    return array
