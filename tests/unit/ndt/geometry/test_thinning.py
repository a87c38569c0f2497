# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Downsampling of a large cloud to a number of points."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.geometry.thinning import spread_indices

pytestmark = pytest.mark.unit

RINGS, COLUMNS = 64, 1000
WANTED = RINGS * COLUMNS // 16  # every 16th point would be from four rings only


@pytest.mark.parametrize("count", [0, 1, WANTED])
def test_a_small_cloud_is_taken_whole(count):
    points = np.arange(count)
    np.testing.assert_array_equal(points[spread_indices(count, WANTED)], points)


@pytest.mark.parametrize("count", [WANTED + 1, RINGS * COLUMNS])
def test_all_parts_of_a_large_cloud_are_there_alike(count):
    chosen = np.arange(count)[spread_indices(count, WANTED)]
    assert len(np.unique(chosen)) == WANTED
    assert (np.diff(chosen) > 0).all()
    assert np.abs(chosen - np.arange(WANTED) * (count / WANTED)).max() <= count / WANTED


def test_no_ring_is_missing_whatever_the_order_of_the_points():
    ring = np.tile(np.arange(RINGS), COLUMNS)  # column by column
    _, counts = np.unique(ring[spread_indices(len(ring), WANTED)], return_counts=True)
    assert len(counts) == RINGS
    assert counts.min() > 0.5 * counts.max()


def test_the_choice_is_the_same_each_time():
    first, second = (np.arange(10**5)[spread_indices(10**5, 999)] for _ in range(2))
    np.testing.assert_array_equal(first, second)
