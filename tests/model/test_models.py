# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The formal models of the data path hold, and each seeded bug is found.

Searches of some seconds are left to `make stress`.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import pytest

CHECKER = Path(__file__).resolve().parents[2] / "docs" / "model" / "check.py"

spec = importlib.util.spec_from_file_location("check_models", CHECKER)
assert spec is not None
assert spec.loader is not None
check_models = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = check_models  # dataclasses look up their module here
spec.loader.exec_module(check_models)

CASES = check_models.cases()


def parameters(cases: list[Any]) -> list[Any]:
    return [
        pytest.param(case, id=case.name, marks=[pytest.mark.stress] if case.is_long else [])
        for case in cases
    ]


pytestmark = pytest.mark.needs(*check_models.PROGRAMS)


@pytest.mark.parametrize("case", parameters([case for case in CASES if not case.bug]))
def test_model_holds(case) -> None:
    assert check_models.check(case).violation == ""


@pytest.mark.parametrize("case", parameters([case for case in CASES if case.bug]))
def test_seeded_bug_is_found(case) -> None:
    assert check_models.check(case).violation != ""


def test_every_model_has_seeded_bugs() -> None:
    assert {case.model for case in CASES} == {case.model for case in CASES if case.bug}
