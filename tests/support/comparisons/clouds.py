# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Point clouds read by us, by PCL (its results are kept) and by Open3D (where it is installed)."""

from __future__ import annotations

import importlib.util
import random
from pathlib import Path

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.files.cloud_file import load_open3d, read_cloud
from support.comparisons.comparing import DisagreementError, run
from support.comparisons.pcl_results import FILE, checksum
from support.generated import clouds, ply
from support.generated.mutation import damaged

OPEN3D = load_open3d() if importlib.util.find_spec("open3d") else None
RESULTS = np.load(FILE)
PATCHES = (b"-1", b"9" * 20, b"\0", b"\n", b"nan", b" ")


def ours(path: Path, content: bytes) -> np.ndarray | None:
    path.write_bytes(content)
    try:
        return read_cloud(path)
    except ManycoreError as error:
        if not str(error).isprintable() or not str(error).startswith(f"map {path}: "):
            raise DisagreementError(f"not one line about the map: {error}") from error
        return None


def compare_pcd(directory: Path, number: int) -> str:
    made = clouds.made(number)
    found, real = ours(directory / "A.PCD", made.content), int(RESULTS[number])
    if (0 if found is None else checksum(found)) != real:
        raise DisagreementError(f"{found}, PCL {real}: {made.content!r}")
    return "PCD refused" if found is None else "PCD read"


def compare_ply(directory: Path, number: int) -> str:
    made, path = ply.made(number), directory / "a.ply"
    found = ours(path, made.content)
    if made.is_cut:
        if found is not None:
            raise DisagreementError(f"a cut file is read: {made.content!r}")
        return "PLY refused"
    if found is None or not np.array_equal(found, made.points):
        raise DisagreementError(f"{found}, written {made.points}: {made.content!r}")
    if OPEN3D is not None and made.is_ordered:
        real = np.asarray(OPEN3D.io.read_point_cloud(str(path)).points)
        if not np.array_equal(real, found):
            raise DisagreementError(f"{found}, Open3D {real}: {made.content!r}")
    return "PLY read"


def compare(directory: Path, number: int) -> str:
    chance = random.Random(number)
    maker, suffix = chance.choice(((clouds, ".pcd"), (ply, ".ply")))
    ours(directory / f"damaged{suffix}", damaged(chance, maker.made(number).content, PATCHES))
    return f"{compare_pcd(directory, number)}, {compare_ply(directory, number)}"


if __name__ == "__main__":
    run(compare)
