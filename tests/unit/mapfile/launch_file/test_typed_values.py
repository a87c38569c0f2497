# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated launch files have the values that launch gives them, as rcl reads them."""

from __future__ import annotations

from pathlib import Path

import pytest

from support.comparisons.comparing import FEW, compared
from support.comparisons.launch_values import by_us, write
from support.generated.launch_files import node, tag, xml

pytestmark = pytest.mark.unit

SIZE = FEW // 2  # of a part: two processes share the work


@pytest.mark.parametrize("first", range(0, FEW, SIZE))
def test_values_are_those_that_launch_gives(first: int, tmp_path: Path) -> None:
    counted = compared("launch_files", tmp_path, range(first, first + SIZE))
    assert min(counted["read"], counted["refused"]) > SIZE / 4, counted


@pytest.mark.parametrize(
    ("substitution", "expected"),
    [
        ("equals 0.3 0.30000000000000004", "true"),
        ("equals 1 1.0000000001", "true"),
        ("equals 1 1.00001", "false"),
        ("not-equals 1e3 1000.0", "false"),
        ("equals True 1", "true"),
        ("equals 0 FALSE", "true"),
        ("equals true yes", "false"),
        ("equals nan nan", "false"),
        ("equals a A", "false"),
        ("not on", "false"),
        ("any no off true", "true"),
        ("all yes on 1", "true"),
        ("all yes on 0", "false"),
    ],
)
def test_logic_in_text(substitution: str, expected: str, tmp_path: Path) -> None:
    """Launch 3.4.3 knows `any` and `all` in text, but fails to construct them."""
    launch = xml(node(tag("param", name="r", value=f"$({substitution})", type="str")))
    (found,) = by_us(write(tmp_path, 0, launch)) or [None]
    assert found == [["__node:=n"], {"r": repr(expected)}]
