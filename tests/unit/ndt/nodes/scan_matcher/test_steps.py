# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Statistics of an alignment's steps, and the colours of scores."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.ndt import Alignment, MatcherOptions
from rmw_manycore_py.ndt.nodes.scan_matcher.colors import colors, packed_colors
from rmw_manycore_py.ndt.nodes.scan_matcher.steps import count_oscillations, has_ended

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
        ((0.0, 1.0, 1.0, 0.0), 0),  # a step that was reverted leads nowhere
    ],
)
def test_oscillations_are_turns_back_in_a_row(x, expected):
    assert count_oscillations(path(*x)) == expected


def test_a_turn_of_a_right_angle_is_none():
    poses = path(0.0, 1.0, 1.0)
    poses[2, 1, 3] = 1.0
    assert count_oscillations(poses) == 0


@pytest.mark.parametrize(
    ("steps", "is_degenerate", "expected"),
    [(12, False, True), (11, False, False), (12, True, False)],
)
def test_an_alignment_that_oscillates_has_ended(steps, is_degenerate, expected):
    """As in Autoware, which requires more than ten reversals in a row."""
    to_and_fro = path(*(n % 2 for n in range(steps + 1)))
    refused = Alignment.refused(np.eye(4), "still moving", MatcherOptions())
    alignment = replace(refused, path=to_and_fro, is_degenerate=is_degenerate)
    assert has_ended(alignment) is expected


def test_colours_go_from_blue_over_green_to_red():
    found = colors([-1.0, 0.0, 0.25, 0.5, 1.0])
    expected = [[0, 0, 1], [0, 0, 1], [0, 1, 1], [0, 1, 0], [1, 0, 0]]
    np.testing.assert_allclose(found, expected, atol=1e-3)
    assert packed_colors([0.0]).view(np.uint32)[0] == 0x0000FF
