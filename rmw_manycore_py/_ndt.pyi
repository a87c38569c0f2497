# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The native scan matcher."""

import enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

class NdtError(RuntimeError): ...

class Search(enum.Enum):
    radius = 0
    direct7 = 1
    direct1 = 2

class VoxelCovariance(enum.Enum):
    pcl = 0
    autoware = 1
    pclomp = 2

class StepRule(enum.Enum):
    trust_region = 0
    clamped = 1
    more_thuente = 2

class VoxelMap:
    def __init__(
        self,
        points: NDArray[np.float64],
        *,
        voxel_size_m: float,
        search: Search,
        covariance: VoxelCovariance,
        min_points_per_voxel: int,
    ) -> None: ...
    @property
    def voxels(self) -> int: ...
    @property
    def size_bytes(self) -> int: ...

class MatchOptions:
    def __init__(
        self,
        *,
        step_rule: StepRule,
        max_iterations: int,
        step_size: float,
        trans_epsilon: float,
        outlier_ratio: float,
        regularization_scale_factor: float,
    ) -> None: ...

class SerialMatcher:
    def __init__(self, options: MatchOptions) -> None: ...
    def align(
        self,
        map: VoxelMap,
        points: NDArray[np.float32],
        guess: NDArray[np.float64],
        regularization_position_m: tuple[float, float] | None = None,
    ) -> dict[str, Any]: ...
    def evaluate(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64]
    ) -> dict[str, Any]: ...
    def time_passes_ns(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64], passes: int
    ) -> list[float]: ...
    def time_shares_ns(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64], workers: int
    ) -> list[float]: ...
    def profile_ns(
        self, map: VoxelMap, points: NDArray[np.float32], guess: NDArray[np.float64]
    ) -> dict[str, float]: ...

class ThreadMatcher:
    def __init__(
        self, options: MatchOptions, derivative_cpus: list[int], search_cpus: list[int]
    ) -> None: ...
    def align(
        self,
        map: VoxelMap,
        points: NDArray[np.float32],
        guess: NDArray[np.float64],
        regularization_position_m: tuple[float, float] | None = None,
    ) -> dict[str, Any]: ...
    def evaluate(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64]
    ) -> dict[str, Any]: ...

class WorkerGroup:
    def __init__(self, options: MatchOptions, program: str, host_cpus: list[int]) -> None: ...
    def align(
        self,
        map: VoxelMap,
        points: NDArray[np.float32],
        guess: NDArray[np.float64],
        regularization_position_m: tuple[float, float] | None = None,
    ) -> dict[str, Any]: ...
    def evaluate(
        self, map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64]
    ) -> dict[str, Any]: ...
    def prepare(self, map: VoxelMap) -> None: ...
    def memory_bytes(self, points: int) -> int: ...
    def pids(self) -> list[int]: ...
    def busy_ns(self) -> list[float]: ...
    def replaced(self) -> int: ...

def simd() -> str: ...
