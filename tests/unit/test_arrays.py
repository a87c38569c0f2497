# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages without copies, where Python cannot have them."""

from __future__ import annotations

import sys
from types import ModuleType

import pytest

import rmw_manycore_arrays as arrays

pytestmark = pytest.mark.unit

FAULT = "Python runs without a global interpreter lock"


def test_a_python_without_it_copies_and_warns_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The compiled module of a free-threaded build returns this fault and nothing else."""
    native = ModuleType("_rmw_manycore_arrays")
    native.find_fault = lambda: FAULT  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, native.__name__, native)
    monkeypatch.setattr(arrays, "_native", None)
    for _ in range(2):
        assert not arrays._compiled()
    assert capsys.readouterr().err == f"rmw_manycore: large messages are copied: {FAULT}\n"
