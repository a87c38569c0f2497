# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""small_gicp or Open3D as a peer: `python_peer NAME WORLD VOXEL_SIZE`; protocol as in peer.cpp."""

from __future__ import annotations

import struct
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

THINNING_M = 0.25
REACH_M = 1.0
# (voxel size, correspondence distance) of multi-scale ICP; the first covers the guesses' errors.
SCALES_M = ((1.0, 5.0), (0.5, 2.0), (THINNING_M, REACH_M))
ITERATIONS = 30

Align = Callable[[NDArray[np.float64], NDArray[np.float64]], tuple[int, NDArray[np.float64]]]


def read_world(path: Path) -> tuple[Any, list[tuple[Any, Any, Any]]]:
    """Return the map's points, and pose, guess and points of each scan."""
    data = path.read_bytes()
    offset = 0

    def count() -> int:
        nonlocal offset
        offset += 8
        return int(struct.unpack_from("<Q", data, offset - 8)[0])

    def numbers(kind: str, many: int, columns: int) -> Any:
        nonlocal offset
        found = np.frombuffer(data, kind, many * columns, offset).reshape(many, columns)
        offset += found.nbytes
        return found.astype(np.float64)

    points = numbers("<f4", count(), 3)
    scans = []
    for _ in range(count()):
        pose, guess = numbers("<f8", 4, 4), numbers("<f8", 4, 4)
        scans.append((pose, guess, numbers("<f4", count(), 3)))
    return points, scans


def small_gicp_aligner(points: Any) -> Align:
    """Return single-threaded GICP; the map is preprocessed once, scans each time."""
    import small_gicp

    target, tree = small_gicp.preprocess_points(points, THINNING_M)

    def align(scan: Any, guess: Any) -> tuple[int, Any]:
        source, _ = small_gicp.preprocess_points(scan, THINNING_M)
        found = small_gicp.align(
            target, source, tree, guess, registration_type="GICP", max_iterations=ITERATIONS
        )
        return found.iterations, found.T_target_source

    return align


def open3d_aligner(points: Any) -> Align:
    """Return point-to-plane ICP; the map is preprocessed once, scans each time."""
    import open3d

    def cloud_of(array: Any) -> Any:
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(array))
        return cloud.voxel_down_sample(THINNING_M)

    target = cloud_of(points)
    target.estimate_normals()
    registration = open3d.pipelines.registration
    plane = registration.TransformationEstimationPointToPlane()
    criteria = registration.ICPConvergenceCriteria(max_iteration=ITERATIONS)

    def align(scan: Any, guess: Any) -> tuple[int, Any]:
        found = registration.registration_icp(
            cloud_of(scan), target, REACH_M, guess, plane, criteria
        )
        return ITERATIONS, found.transformation

    return align


def open3d_multi_scale_aligner(points: Any) -> Align:
    """Return point-to-plane ICP on increasingly fine clouds."""
    import open3d

    registration = open3d.pipelines.registration
    plane = registration.TransformationEstimationPointToPlane()
    criteria = registration.ICPConvergenceCriteria(max_iteration=ITERATIONS)

    def cloud_of(array: Any, thinning_m: float) -> Any:
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(array))
        return cloud.voxel_down_sample(thinning_m)

    targets = [cloud_of(points, thinning_m) for thinning_m, _ in SCALES_M]
    for target in targets:
        target.estimate_normals()

    def align(scan: Any, guess: Any) -> tuple[int, Any]:
        pose = guess
        for target, (thinning_m, reach_m) in zip(targets, SCALES_M, strict=True):
            source = cloud_of(scan, thinning_m)
            found = registration.registration_icp(source, target, reach_m, pose, plane, criteria)
            pose = found.transformation
        return ITERATIONS, pose

    return align


def main() -> None:
    """Answer requests until end of input."""
    aligners = {"small_gicp": small_gicp_aligner, "open3d": open3d_aligner}
    points, scans = read_world(Path(sys.argv[2]))
    align = aligners[sys.argv[1]](points)
    print("ready", flush=True)
    for line in sys.stdin:
        _, guess, scan = scans[int(line.split()[1])]
        start_ns = time.perf_counter_ns()
        iterations, found = align(scan, guess)
        elapsed_ns = time.perf_counter_ns() - start_ns
        print(elapsed_ns, iterations, *np.asarray(found).ravel(), flush=True)


if __name__ == "__main__":
    main()
