# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pairs of runs: the interval covers the difference of the builds, not the machine's drift."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import pytest

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.pairs import LIBRARY, Comparison, compare, in_turns
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


def test_builds_take_turns_and_turns_to_be_first() -> None:
    this, other = (replace(INSIDE, name=name) for name in ("this", "other"))
    order = [side.name for side in in_turns(this, other, 3)]
    assert order == ["this", "other", "other", "this", "this", "other"]


def test_stand_ins_come_first_and_then_the_build_they_lead_to(tmp_path: Path) -> None:
    """The library that the stand-in replaces may lie beside a build, as in a prefix."""
    for name in ("librmw_fastrtps_cpp.so", LIBRARY):
        (tmp_path / name).touch()
    path = library_path(replace(INSIDE, build=tmp_path))

    def first_with(library: str) -> Path:
        return next(Path(entry) for entry in path if Path(entry, library).exists())

    assert first_with("librmw_fastrtps_cpp.so") == native_directory() / "standin"
    assert first_with(LIBRARY) == tmp_path
    assert Path(path[2], LIBRARY).exists(), "without the other build it is this one"
