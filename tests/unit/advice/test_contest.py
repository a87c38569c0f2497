# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ratios between measured mappings."""

from __future__ import annotations

import math

import pytest

from rmw_manycore_py.bench.advise.contest import Contest, Mapping
from rmw_manycore_py.bench.predict.figures import Figures, Times

pytestmark = pytest.mark.unit


def mapping(*p99s_us: float) -> Mapping:
    """Return a mapping with runs of these p99, and a maximum twice as long."""
    return Mapping(
        "mapping",
        tuple(
            Figures(chains={"c": Times(count=100, p50_us=1.0, p99_us=p99, max_us=2 * p99)}, cpus={})
            for p99 in p99s_us
        ),
    )


def contest(*random: Mapping) -> Contest:
    return Contest("c", mapping(9.0), mapping(4.0, 2.0, 3.0), random, mapping(60.0), mapping(6.0))


def test_an_advised_mapping_is_compared_by_the_medians_of_its_runs() -> None:
    found = contest(mapping(6.0, 6.0, 90.0), mapping(2.0), mapping(12.0))
    assert (found.of_median, found.of_best) == (0.5, 1.5)


def test_worst_cases_are_the_maxima_beside_busy_loops() -> None:
    assert contest(mapping(1.0)).of_worst_case == 0.1


def test_a_mapping_whose_chain_was_incomplete_in_a_run_is_slower_than_any_other() -> None:
    stuck = Mapping("stuck", (*mapping(1.0).runs, Figures(chains={}, cpus={})))
    assert stuck.p99_us("c") == math.inf
    assert contest(stuck, mapping(6.0), mapping(6.0)).of_median == 0.5
