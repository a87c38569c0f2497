# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Search, sums and tiles give the poses of the matcher that does all at once.

On recorded scans where there are some, else in a simulated street.
"""

from __future__ import annotations

import threading

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.matching.kernel_options import map_options, match_options
from rmw_manycore_py.papers.roslite.localization.alignment import (
    Prediction,
    aligned,
    pairs_in,
    sums_of,
)
from rmw_manycore_py.papers.roslite.localization.options import OPTIONS, TILE_M
from rmw_manycore_py.papers.roslite.localization.remote_pass import (
    Part,
    PassesEndedError,
    RemotePass,
)
from rmw_manycore_py.papers.roslite.localization.swapping import Pooled, SwappedTiles
from rmw_manycore_py.papers.roslite.localization.tiles import (
    TileKey,
    joined,
    points_by_tile,
    split,
    tiles_of,
)

pytestmark = pytest.mark.unit

POINTS = voxel_centroids(world(4, step=8).map_points, (0.25,) * 3).astype(np.float64)
SCANS = [voxel_centroids(scan, (1.0,) * 3) for scan in world(4, step=8).scans]
GUESSES = [np.ascontiguousarray(guess) for guess in world(4, step=8).guesses]
TILES = tiles_of(POINTS, TILE_M, OPTIONS)
WHOLE = _ndt.VoxelMap(POINTS, map_options(OPTIONS))
POOL = {key: Pooled(tile.shared_path, tile.size_bytes) for key, tile in TILES.items()}
LARGEST = max(tile.size_bytes for tile in TILES.values())
EACH = pytest.mark.parametrize("number", range(len(SCANS)))


@EACH
def test_the_derivatives_of_the_parts_are_those_of_the_whole(number):
    scan, pose = SCANS[number], GUESSES[number]
    found = pairs_in(TILES, scan, pose, TILE_M)
    parts = split(found, 5)
    sums = sum(sums_of(part, OPTIONS) for part in parts)
    of_parts = _ndt.derivatives_at(sums, pose, OPTIONS.outlier_ratio, OPTIONS.voxel_size_m)
    of_whole = _ndt.SerialMatcher(match_options(OPTIONS)).evaluate([WHOLE], scan, pose)
    assert of_parts.pairs == of_whole.pairs == len(found[1])
    assert of_parts.points == of_whole.points
    assert of_parts.score == pytest.approx(of_whole.score, rel=1e-5)
    assert of_parts.nearest == pytest.approx(of_whole.nearest, rel=1e-5)
    for name in ("gradient", "hessian"):
        expected = getattr(of_whole, name)
        tolerance = 1e-4 * np.abs(expected).max()  # the whole is summed in single precision
        assert getattr(of_parts, name) == pytest.approx(expected, abs=tolerance)


@EACH
def test_the_pose_is_that_of_the_whole(number):
    scan, guess = SCANS[number], GUESSES[number]
    found = aligned(
        guess, lambda pose: sums_of(pairs_in(TILES, scan, pose, TILE_M), OPTIONS), OPTIONS
    )
    expected = _ndt.SerialMatcher(match_options(OPTIONS)).align([WHOLE], scan, guess)
    assert found.outcome == expected.outcome
    assert found.pose == pytest.approx(expected.pose, abs=1e-3)


def test_the_parts_hold_whole_points_and_all_pairs():
    found = pairs_in(TILES, SCANS[0], GUESSES[0], TILE_M)
    for count in (1, 2, 5):
        parts = split(found, count)
        assert len(parts) == count
        assert [int(counts.sum()) for counts, _ in parts] == [len(pairs) for _, pairs in parts]
        for whole, again in zip(found, joined(parts), strict=True):
            assert np.array_equal(whole, again)
        sizes = [len(pairs) for _, pairs in parts]
        assert max(sizes) - min(sizes) < 60


@pytest.mark.parametrize("count", [1, 5])
def test_without_pairs_all_parts_are_empty(count):
    nowhere = np.eye(4)
    nowhere[0, 3] = 1e5
    found = pairs_in(TILES, SCANS[0], nowhere, TILE_M)
    assert [len(pairs) for _, pairs in split(found, count)] == [0] * count
    ended = aligned(nowhere, lambda _: sums_of(found, OPTIONS), OPTIONS)
    assert ended.outcome == "no_overlap"


def test_counts_and_pairs_that_differ_are_refused():
    counts, pairs = pairs_in(TILES, SCANS[0], GUESSES[0], TILE_M)
    with pytest.raises(ManycoreError, match=f"expected {len(pairs)}, the sum of the counts"):
        sums_of((counts, pairs[:-1]), OPTIONS)


def test_tiles_of_broken_voxels_and_a_map_without_voxels_are_refused():
    with pytest.raises(ManycoreError, match="expected a multiple of the voxels' 1 m"):
        tiles_of(POINTS, 15.5, OPTIONS)
    with pytest.raises(ManycoreError, match="no voxel with enough points"):
        tiles_of(POINTS[:3], TILE_M, OPTIONS)


def test_swapped_tiles_fit_their_room_and_find_the_same():
    charges: list[int] = []
    room = LARGEST + min(tile.size_bytes for tile in TILES.values())
    tiles = SwappedTiles(POOL, room, charges.append)
    for scan, pose in zip(SCANS, GUESSES, strict=True):
        parts = points_by_tile(scan, pose, TILE_M)
        found = joined(
            _ndt.search_pairs(tile, parts[key], pose) for key, tile in tiles.visit(parts)
        )
        expected = sums_of(pairs_in(TILES, scan, pose, TILE_M), OPTIONS)
        assert sums_of(found, OPTIONS) == pytest.approx(expected, rel=1e-6)
    assert 0 < max(charges) <= room
    assert tiles.swaps > len(TILES)


def test_what_is_in_smem_is_visited_first_and_not_copied_again():
    first, second = list(TILES)[:2]
    tiles = SwappedTiles(POOL, sum(tile.size_bytes for tile in TILES.values()), lambda _: None)
    assert [key for key, _ in tiles.visit([second])] == [second]
    assert [key for key, _ in tiles.visit([first, second])] == [second, first]
    assert (tiles.swaps, tiles.held) == (2, (second, first))
    assert list(tiles.visit([TileKey(10_000, 0)])) == []


def test_a_tile_that_fits_no_smem_and_a_pool_without_its_owner():
    with pytest.raises(ManycoreError, match=r"at most smem_bytes = 5000, found .*smaller tiles"):
        SwappedTiles(POOL, 5000, lambda _: None)
    gone = SwappedTiles({TileKey(0, 0): Pooled("/proc/0/fd/3", 10)}, 100, lambda _: None)
    with pytest.raises(ManycoreError, match="is lidar_localizer running"):
        list(gone.visit([TileKey(0, 0)]))


def test_tiles_make_room_where_the_cluster_has_none():
    first, second = sorted(TILES, key=lambda key: TILES[key].size_bytes)[:2]
    limit = POOL[second].size_bytes

    def charge(size_bytes: int) -> None:
        if size_bytes > limit:
            raise ManycoreError("no room")

    tiles = SwappedTiles(POOL, 10 * LARGEST, charge)
    for key in (first, second):
        assert [found for found, _ in tiles.visit([key])] == [key]
        assert tiles.held == (key,)
    limit = 0
    with pytest.raises(ManycoreError, match="no room"):
        list(tiles.visit([first]))


def test_a_pass_waits_for_all_its_parts_and_ignores_those_of_others():
    asked = []
    remote = RemotePass(lambda *question: asked.append(question), 2, timeout_s=60.0)
    remote.begin(7)
    ones = np.ones(37)
    remote.arrived(Part(7, 9, 0, 100 * ones))  # of a pass that was given up
    remote.arrived(Part(6, 1, 0, 100 * ones))  # of a scan that was given up
    answers = [Part(7, 1, 1, 2 * ones), Part(7, 1, 0, ones)]
    threading.Thread(target=lambda: [remote.arrived(part) for part in answers]).start()
    assert remote(np.eye(4)) == pytest.approx(3 * ones)
    ((scan_ns, number, pose),) = asked
    assert (scan_ns, number, pose.tolist()) == (7, 1, np.eye(4).tolist())


def test_a_pass_whose_derivatives_are_silent_is_given_up():
    remote = RemotePass(lambda *_: None, 2, timeout_s=0.05)
    remote.begin(1)
    remote.arrived(Part(1, 1, 0, np.ones(37)))
    is_over = threading.Event()

    def look() -> None:
        while not is_over.is_set():
            remote.look()

    timer = threading.Thread(target=look)
    timer.start()
    with pytest.raises(ManycoreError, match=r"pass 1: 1 of 2 derivatives answered in 0\.05 s"):
        aligned(np.eye(4), remote, OPTIONS)
    is_over.set()
    timer.join()


def test_a_pass_that_is_not_late_goes_on_and_ends_with_the_node():
    remote = RemotePass(lambda *_: remote.look(), 2, timeout_s=60.0)
    threading.Timer(0.0, remote.close).start()
    with pytest.raises(PassesEndedError):
        remote(np.eye(4))


def test_a_guess_goes_on_with_the_last_motion():
    turn = np.eye(4)
    turn[:2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    turn[0, 3] = 1.0
    prediction = Prediction(np.eye(4), 10.0)
    assert prediction.guess(10.1) == pytest.approx(np.eye(4))
    prediction.update(turn, 10.1)
    assert prediction.guess(10.2) == pytest.approx(turn @ turn)
    assert prediction.guess(10.9) == pytest.approx(turn)  # too long ago
