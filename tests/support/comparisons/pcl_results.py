# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What PCL 1.13 reads from the files of generated/clouds, as checksums: 0 where it refuses one.

Files from which PCL invents points, or which crash it, count as refused. The program of
tests/programs/read_pcd.cpp makes the results anew, in tests/:

    python -m support.comparisons.pcl_results read_pcd 10000
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

from support import TESTS
from support.generated.clouds import made

FILE = TESTS / "unit/ndt/files/pcl_results.npy"


def checksum(points: np.ndarray) -> int:
    """Return a checksum of points (N, 3), never 0."""
    values = np.where(np.isnan(points), np.nan, points.astype("<f8"))
    return zlib.crc32(values.tobytes()) or 1


def _lines(reader: str, paths: list[Path]) -> list[str]:
    lines: list[str] = []
    while len(lines) < len(paths):
        text = "".join(f"{path}\n" for path in paths[len(lines) :])
        done = subprocess.run([reader], input=text, capture_output=True, text=True, check=False)
        lines += done.stdout.splitlines()
        if len(lines) < len(paths):  # this file has crashed it
            lines.append("refused")
    return lines


def _write(reader: str, count: int) -> None:
    results = np.zeros(count, np.uint32)
    with tempfile.TemporaryDirectory() as directory:
        paths = [Path(directory, f"{number}.pcd") for number in range(count)]
        for number, path in enumerate(paths):
            path.write_bytes(made(number).content)
        for number, line in enumerate(_lines(reader, paths)):
            if line != "refused" and not made(number).invents:
                words = (word if "n" in word else float.fromhex(word) for word in line.split())
                results[number] = checksum(np.array([*words], np.float64).reshape(-1, 3))
    np.save(FILE, results)


if __name__ == "__main__":
    _write(sys.argv[1], int(sys.argv[2]))
