# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Map and scans for all contenders, and their binary format for peers."""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.ndt.recordings.recording import Recording, load_recording
from rmw_manycore_py.ndt.simulation.drive import poses_along, scans_along
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import build_street

DATA_VARIABLE = "MANYCORE_DATA"
RECORDING = "balm_seq177_v0.10.npz"
SCANS = 6
GUESS_OFFSET_M = (0.3, -0.3, 0.1)


@dataclass(frozen=True)
class RecordedWorld:
    """A map of every second scan of a drive, and some of the others.

    :param map_points: (N, 3) [m, map frame].
    :param scans: (n, 3) each [m, sensor frame].
    :param poses: T_map_sensor (S, 4, 4).
    :param guesses: poses with an offset of 0.44 m.
    """

    name: str
    map_points: NDArray[np.float32]
    scans: list[NDArray[np.float32]]
    poses: NDArray[np.float64]
    guesses: NDArray[np.float64]

    def write(self, path: Path) -> None:
        """Write the format read by bench/ndt/peer.cpp."""
        with path.open("wb") as file:
            _write_points(file.write, self.map_points)
            file.write(struct.pack("<Q", len(self.scans)))
            for scan, pose, guess in zip(self.scans, self.poses, self.guesses, strict=True):
                file.write(pose.astype("<f8").tobytes() + guess.astype("<f8").tobytes())
                _write_points(file.write, scan)


def _write_points(write: object, points: NDArray[np.float32]) -> None:
    assert callable(write)
    write(struct.pack("<Q", len(points)) + points.astype("<f4").tobytes())


@cache
def world(scans: int = SCANS, first: int = 0, step: int = 2) -> RecordedWorld:
    """Return the recorded drive, or a simulated one if there is no recording.

    :param scans: maximum number of the odd scans, which are not part of the map.
    :param first: first scan of the map, an even one; `step` to the next one.
    """
    return world_of(*recorded(), scans, first, step)


def world_of(
    recording: Recording, name: str, scans: int, first: int = 0, step: int = 2
) -> RecordedWorld:
    """Return the world of a recording; parameters as for `world`."""
    last = (len(recording) - 1) // 2 * 2 - 1
    odd = np.unique(np.linspace(1, last, scans).astype(int) // 2 * 2 + 1)
    odd = odd[odd < len(recording)]
    poses = recording.poses[odd]
    guesses = poses.copy()
    guesses[:, :3, 3] += GUESS_OFFSET_M
    return RecordedWorld(
        name=name,
        map_points=recording.accumulated(range(first, len(recording), step)).astype(np.float32),
        scans=[np.ascontiguousarray(recording.scan(i)) for i in odd],
        poses=poses,
        guesses=guesses,
    )


def recorded() -> tuple[Recording, str]:
    """Return the recording and its name; a simulated drive where there is none."""
    checkout = Path(__file__).resolve().parents[3]
    directory = Path(os.environ.get(DATA_VARIABLE, checkout.parent / "shared" / "data"))
    if (directory / RECORDING).exists():
        return load_recording(directory / RECORDING), RECORDING
    generator = np.random.default_rng(1)
    poses = poses_along(np.arange(0.0, 40.0, 2.0))
    scans = list(scans_along(build_street(40.0, generator), poses, Lidar(), generator))
    return Recording(scans, poses, np.zeros(0), "synthetic street, seed 1"), "synthetic street"
