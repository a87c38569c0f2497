# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mutated mapfiles, launch files, parameter files and bridge files; the stress tests have more."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError, Problem
from support.comparisons.mutated_files import complaint, read_mutated

pytestmark = pytest.mark.unit


def test_mutated_files_are_read_or_refused_in_one_line_per_problem(tmp_path: Path) -> None:
    status, said = read_mutated(tmp_path, range(150))
    assert status == 0, said


def test_other_ends_are_seen() -> None:
    problem = Problem(Path("file.yaml"), 1, "key", "this", "that")
    assert complaint(MapfileError(problem)) is None
    assert complaint(RecursionError("too deep")) == "RecursionError: too deep"
    lines = MapfileError(problem)
    lines.args = ("one\ntwo",)
    assert complaint(lines) == "not one line per problem: one\ntwo"
