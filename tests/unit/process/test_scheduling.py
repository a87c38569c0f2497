# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Priorities above those of others."""

from __future__ import annotations

import pytest

from rmw_manycore_py.process.scheduling import Scheduling, priority_above

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ([], 0),
        ([Scheduling("other")], 0),
        ([Scheduling("rr", 3), Scheduling("other"), Scheduling("fifo", 1)], 4),
        ([Scheduling("fifo", 99)], 99),
    ],
)
def test_a_priority_above_all_is_real_time_only_if_one_of_them_is(
    given: list[Scheduling], expected: int
) -> None:
    assert priority_above(given) == expected
