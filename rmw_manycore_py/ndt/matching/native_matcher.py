# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a matcher in C++ offers, with or without workers."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints

Position = tuple[float, float]


class NativeMatcher(Protocol):
    """Interface of the kernel, with or without workers."""

    def align(
        self,
        maps: list[_ndt.VoxelMap],
        points: ScanPoints,
        guess: Pose,
        regularization_position_m: Position | None = None,
        first: int = 0,
        polishing: int = 0,
        surpassed: float = -np.inf,
        min_fit: float = -np.inf,
    ) -> _ndt.NewtonResult:
        """Align from a guess to one map after the other; the last `polishing` refine the pose.

        :param surpassed: minimum score with which the scored map is begun, else the end.
        :param min_fit: fit that few points have to exceed for the pose to be refined.
        """
        ...

    def evaluate(
        self,
        maps: list[_ndt.VoxelMap],
        points: ScanPoints,
        pose: Pose,
        polishing: int = 0,
    ) -> _ndt.Derivatives:
        """Return score and derivatives at a pose on the last map but `polishing`."""
        ...

    def search(self, search: _ndt.PlaceSearch, descends: bool, for_s: float) -> bool:
        """Work on a phase of a search; return whether all of it is done."""
        ...
