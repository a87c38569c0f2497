# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What an alignment's steps tell, and the colours of scores."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.ndt.nodes.scan_matcher.colors import colors, packed_colors
from rmw_manycore_py.ndt.nodes.scan_matcher.steps import count_oscillations

pytestmark = pytest.mark.unit


def path(*x: float) -> np.ndarray:
    poses = np.tile(np.eye(4), (len(x), 1, 1))
    poses[:, 0, 3] = x
    return poses


@pytest.mark.parametrize(
    ("x", "expected"),
    [
        ((0.0,), 0),
        ((0.0, 1.0), 0),
        ((0.0, 1.0, 2.0, 3.0), 0),
        ((0.0, 1.0, 0.0, 1.0, 0.0), 3),
        ((0.0, 1.0, 0.0, -1.0, 0.0, -1.0), 2),  # twice in a row after once
        ((0.0, 1.0, 1.0, 0.0), 0),  # a step that was taken back leads nowhere
    ],
)
def test_oscillations_are_turns_back_in_a_row(x, expected):
    assert count_oscillations(path(*x)) == expected


def test_a_turn_of_a_right_angle_is_none():
    poses = path(0.0, 1.0, 1.0)
    poses[2, 1, 3] = 1.0
    assert count_oscillations(poses) == 0


def test_colours_go_from_blue_over_green_to_red():
    found = colors([-1.0, 0.0, 0.25, 0.5, 1.0])
    expected = [[0, 0, 1], [0, 0, 1], [0, 1, 1], [0, 1, 0], [1, 0, 0]]
    np.testing.assert_allclose(found, expected, atol=1e-3)
    assert packed_colors([0.0]).view(np.uint32)[0] == 0x0000FF
