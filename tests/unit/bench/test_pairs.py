# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pairs of runs: the interval covers the difference of the builds, not the drift of the machine."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import pytest

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.pairs import Comparison, compare
from rmw_manycore_py.bench.session import library_path, native_directory
from rmw_manycore_py.errors import ManycoreError

pytestmark = pytest.mark.unit


def drifting(difference_us: float, pairs: int = 30) -> Comparison:
    draw = random.Random(7)
    machine = [40 + pair + draw.gauss(0, 0.05) for pair in range(pairs)]
    return Comparison(
        tuple(one + difference_us + draw.gauss(0, 0.05) for one in machine), tuple(machine)
    )


def test_the_interval_holds_the_difference_however_the_machine_drifts() -> None:
    for difference_us in (-0.5, 0.0, 0.5):
        low_us, high_us = drifting(difference_us).interval_us()
        assert low_us <= difference_us <= high_us
        assert high_us - low_us < 0.1
    row = drifting(0.5).row()
    assert row["pairs"] == 30
    assert row["interval_us"][0] > 0


def test_a_directory_without_a_build_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match=r"expected a directory with librmw_manycore\.so"):
        compare(tmp_path, 6, (0, 0), lambda _: None)


def test_the_stand_in_comes_before_what_it_stands_in_for() -> None:
    side = replace(INSIDE, library=native_directory().parent)
    path = library_path(side)
    stand_in = next(entry for entry in path if (Path(entry) / "librmw_fastrtps_cpp.so").exists())
    assert Path(stand_in) == native_directory() / "standin"
    assert str(side.library) in path
