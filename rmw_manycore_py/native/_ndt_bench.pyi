# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What only benches of the scan matcher use; maps, options and results are those of `_ndt`."""

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native._ndt import Derivatives, MatchOptions, NewtonResult, VoxelMap

class Profile:
    """Where the time of an alignment goes."""

    @property
    def lay_out_ns(self) -> float:
        """Laying out the scan for the kernel."""

    @property
    def search_ns(self) -> float: ...
    @property
    def derivatives_ns(self) -> float: ...
    @property
    def total_ns(self) -> float: ...

class Profiler:
    """Times the parts of a match on the calling thread."""

    def __init__(self, options: MatchOptions) -> None: ...
    def time_passes_ns(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64], passes: int
    ) -> list[float]:
        """Return what each of `passes` passes at a pose takes, without laying out the scan."""

    def time_shares_ns(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64], workers: int
    ) -> list[float]:
        """Return what each worker's share of a pass takes when this thread does all of them."""

    def profile(
        self, map: VoxelMap, points: NDArray[np.float32], guess: NDArray[np.float64]
    ) -> Profile:
        """Align with search and derivatives one after the other, each timed."""

class ThreadMatcher:
    """Matches on threads of this process, woken for every pass: a peer of the workers.

    With `search_cpus` some threads search and the others add up behind them (ROS-lite, Fig. 15).
    """

    def __init__(
        self, options: MatchOptions, derivative_cpus: list[int], search_cpus: list[int]
    ) -> None: ...
    def align(
        self,
        maps: list[VoxelMap],
        points: NDArray[np.float32],
        guess: NDArray[np.float64],
        regularization_position_m: tuple[float, float] | None = None,
        first: int = 0,
        polishing: int = 0,
    ) -> NewtonResult: ...
    def evaluate(
        self,
        maps: list[VoxelMap],
        points: NDArray[np.float32],
        pose: NDArray[np.float64],
        polishing: int = 0,
    ) -> Derivatives: ...
