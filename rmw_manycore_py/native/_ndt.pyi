# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The native scan matcher."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native.enums import Outcome, Search, StepRule, VoxelCovariance

class NdtError(RuntimeError):
    """Something is wrong with a map, a host CPU or the workers; the message says what."""

class MapOptions:
    """What a map is built with; :class:`MatcherOptions` describes each and has the defaults."""

    def __init__(
        self,
        *,
        voxel_size_m: float,
        search: Search,
        covariance: VoxelCovariance,
        min_points_per_voxel: int,
        widening_m: float,
    ) -> None:
        """Take them; the square of `widening_m` is added to the variances of every voxel."""

class MatchOptions:
    """What scans are matched with; :class:`MatcherOptions` describes each and has the defaults."""

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

class VoxelMap:
    """The normal distributions of points (N, 3) [m, map frame], in memory that workers share."""

    def __init__(
        self, points: NDArray[np.float64], options: MapOptions, without_every: int = 0
    ) -> None:
        """Build it, without every nth point if that is given."""

    def point_scores(
        self, points: NDArray[np.float32], pose: NDArray[np.float64], outlier_ratio: float
    ) -> NDArray[np.float32]:
        """Return of each point (N, 3) the best voxel's score (N,), NaN where it sees none."""

    def point_evidence(
        self, points: NDArray[np.float32], pose: NDArray[np.float64], outlier_ratio: float
    ) -> NDArray[np.float32]:
        """Return (N, 4): score, height in the column, known columns around, 1 behind a surface."""

    def columns_around(
        self, points: NDArray[np.float32], pose: NDArray[np.float64]
    ) -> NDArray[np.uint8]:
        """Return of each point (N, 3) the known columns around (N,), 0 where its own is empty."""

    @staticmethod
    def attach(shared_path: str) -> VoxelMap:
        """Return the map that another process named by `shared_path`; it outlives that process."""

    @property
    def shared_path(self) -> str:
        """Where other processes of this user find the map while this one lives."""

    @property
    def voxels(self) -> int:
        """Number of voxels with a normal distribution."""

    @property
    def size_bytes(self) -> int: ...

class Derivatives:
    """Score at a pose, to be maximised, and its derivatives by x, y, z, roll, pitch, yaw."""

    @property
    def score(self) -> float:
        """Sum over points and the voxels they see (Magnusson, eq. 6.9)."""

    @property
    def nearest(self) -> float:
        """Sum over points of their best voxel's score."""

    @property
    def pairs(self) -> float:
        """Number of pairs of a point and a voxel that it sees."""

    @property
    def points(self) -> float:
        """Number of points that see a voxel."""

    @property
    def scan_points(self) -> int:
        """Number of finite points of the scan."""

    @property
    def gradient(self) -> NDArray[np.float64]:
        """(6,), per m and rad."""

    @property
    def hessian(self) -> NDArray[np.float64]:
        """(6, 6), per m and rad."""

    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """Inverse of the negative Hessian, (6, 6); None where the score has no maximum."""

class NewtonResult:
    """Where an alignment ended."""

    @property
    def outcome(self) -> Outcome: ...
    @property
    def iterations(self) -> int: ...
    @property
    def pose(self) -> NDArray[np.float64]:
        """T_map_sensor (4, 4)."""

    @property
    def at(self) -> Derivatives:
        """The derivatives at this pose."""

    @property
    def first(self) -> Derivatives:
        """The derivatives where the steps on the last map began."""

    @property
    def path(self) -> NDArray[np.float64]:
        """The guess and the pose after each step, on all maps; (n, 4, 4), at most 64."""

class SerialMatcher:
    """Matches scans (N, 3) [m, sensor frame] on the calling thread.

    `maps`: levels of one map, coarsest first; a scan is aligned to each, from where the one before
    has led, from `maps[first]` on. Scores and derivatives are those of the last but `polishing`
    maps: the latter only refine the pose. An alignment ends before these and the scored map unless
    it begins there with a score above `surpassed`. Few points' fit has to exceed `min_fit` for
    the pose to be refined.
    """

    def __init__(self, options: MatchOptions) -> None: ...
    def align(
        self,
        maps: list[VoxelMap],
        points: NDArray[np.float32],
        guess: NDArray[np.float64],
        regularization_position_m: tuple[float, float] | None = None,
        first: int = 0,
        polishing: int = 0,
        surpassed: float = ...,
        min_fit: float = ...,
    ) -> NewtonResult: ...
    def evaluate(
        self,
        maps: list[VoxelMap],
        points: NDArray[np.float32],
        pose: NDArray[np.float64],
        polishing: int = 0,
    ) -> Derivatives: ...
    def search(self, search: PlaceSearch, descends: bool, for_s: float) -> bool:
        """Work on the first or second phase of a search; return whether all of it is done."""

class SearchMap:
    """Where something is in a voxel map, in columns of 1 m, in memory that workers share."""

    def __init__(self, voxel_map: VoxelMap) -> None: ...
    @staticmethod
    def bytes_for(voxel_map: VoxelMap) -> int:
        """Return the bytes of a voxel map's search map, before it is built."""

class SearchOptions:
    """What is searched.

    :param yaws: number of directions in a turn.
    :param kept_permille: places with fewer of the best one's points are not kept.
    :param searched_yaws: number of directions that are searched, from `first_yaw` on.
    """

    def __init__(
        self,
        *,
        yaws: int,
        kept_permille: int,
        centre_m: tuple[float, float],
        radius_m: float,
        first_yaw: int,
        searched_yaws: int,
    ) -> None: ...

class PlaceSearch:
    """A search of the places at which most of some points are at something in the map.

    :param points: (n, 3) [m] of a level scan: x, y from the sensor on, z above the ground.
    """

    def __init__(
        self, search_map: SearchMap, points: NDArray[np.float32], options: SearchOptions
    ) -> None: ...
    @staticmethod
    def bytes_for(search_map: SearchMap, points: int, options: SearchOptions) -> int:
        """Return the bytes of a search for some points, before it is laid out."""

    def order_roots(self) -> None:
        """Sort what the first phase has ranked, for the second one."""

    def found(self, limit: int) -> list[tuple[float, float, float, float, int]]:
        """Return x, y, ground [m], yaw [rad] and points of distinct places, best first."""

class WorkerGroup:
    """Matches on worker processes that run `program`, one per host CPU."""

    def __init__(self, options: MatchOptions, program: str, host_cpus: list[int]) -> None: ...
    def align(
        self,
        maps: list[VoxelMap],
        points: NDArray[np.float32],
        guess: NDArray[np.float64],
        regularization_position_m: tuple[float, float] | None = None,
        first: int = 0,
        polishing: int = 0,
        surpassed: float = ...,
        min_fit: float = ...,
    ) -> NewtonResult: ...
    def evaluate(
        self,
        maps: list[VoxelMap],
        points: NDArray[np.float32],
        pose: NDArray[np.float64],
        polishing: int = 0,
    ) -> Derivatives: ...
    def search(self, search: PlaceSearch, descends: bool, for_s: float) -> bool:
        """Work on the first or second phase of a search; return whether all of it is done."""

    def prepare(self, maps: list[VoxelMap]) -> None:
        """Let the workers map it, so that the next alignment need not wait for that."""

    def memory_bytes(self, points: int) -> int:
        """Return what is shared with the workers beside the map, for scans of `points` points."""

    def pids(self) -> list[int]: ...
    def passes(self) -> list[tuple[int, int, int, int]]:
        """Return worker, pass, begin and end [ns, CLOCK_MONOTONIC] of the last answer's passes."""

    def busy_ns(self) -> list[float]:
        """Return how long each worker was busy in the last job."""

    def replaced(self) -> int:
        """Return how many workers had to be replaced so far."""

def simd() -> str:
    """Return the kind of vector instructions that the kernel uses: avx512, avx2 or portable."""

def search_pairs(
    map: VoxelMap, points: NDArray[np.float32], pose: NDArray[np.float64]
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Return how many voxels each point (N, 3) sees (N,), and the pairs (P, 12), point by point.

    A pair is the point rotated into the map frame, the vector from the voxel's mean to it, and the
    voxel's inverse covariance: xx, xy, xz, yy, yz, zz.
    """

def sums_of_pairs(
    counts: NDArray[np.uint8],
    pairs: NDArray[np.float32],
    outlier_ratio: float,
    voxel_size_m: float,
) -> NDArray[np.float64]:
    """Return the sums (37,) that derivatives are computed from; those of parts can be added."""

def derivatives_at(
    sums: NDArray[np.float64],
    pose: NDArray[np.float64],
    outlier_ratio: float,
    voxel_size_m: float,
) -> Derivatives:
    """Return the derivatives at the pose whose pairs were summed."""

def maximise_sums(
    options: MatchOptions,
    voxel_size_m: float,
    guess: NDArray[np.float64],
    sums_at: Callable[[NDArray[np.float64]], NDArray[np.float64]],
) -> NewtonResult:
    """Find the pose of the highest score; `sums_at` returns the sums (37,) at a pose (4, 4)."""
