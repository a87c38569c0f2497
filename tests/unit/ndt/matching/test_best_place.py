# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which of several places is the best: what fits, what is explained, what is near."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rmw_manycore_py.ndt import Alignment, MatcherOptions
from rmw_manycore_py.ndt.matching.places import best_place
from support.samples.ndt_world import pose

pytestmark = pytest.mark.unit

GUESS = pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def place(x: float, fit: float, explained: float = 0.0, *, converged: bool = True) -> Alignment:
    found = Alignment.refused(pose(x, 0.0, 0.0, 0.0, 0.0, 0.0), "", MatcherOptions())
    found = replace(found, is_degenerate=False, converged=converged, share_in_map=1.0)
    return replace(found, nearest_voxel_likelihood=fit, explained_score=explained)


@pytest.mark.parametrize(
    ("best", "others"),
    [
        (place(8.0, 2.3, 2.95), [place(1.0, 2.3, 2.8)]),  # explained better
        (place(1.0, 2.3, 2.85), [place(8.0, 2.3, 2.9)]),  # not by enough for 7 m
        (place(4.0, 2.85, 2.8), [place(1.0, 2.3, 2.9)]),  # needs less explanation
        (place(8.0, 1.0), [place(1.0, 2.8, 3.0, converged=False)]),  # that is no place
    ],
)
def test_the_best_place(best: Alignment, others: list[Alignment]) -> None:
    for found in ([best, *others], [*others, best]):
        assert best_place(found, GUESS) is best
