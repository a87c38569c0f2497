# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated launch files have the values that launch gives them, as rcl reads them."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
import ros2_packages
from launch_values import by_launch, by_us, write
from made_launch_values import Made, made

pytestmark = pytest.mark.unit

# Outcomes of launch 3.4.3 and launch_ros 0.26.6: `tests/launch_values.py 0 500`.
SEEN = Path(__file__).parent / "values_of_launch.jsonl"
PARTS = 5


@pytest.mark.parametrize("part", range(PARTS))
def test_values_are_those_recorded_from_launch(part: int, tmp_path: Path) -> None:
    lines = SEEN.read_text(encoding="utf-8").splitlines()
    assert len(lines) == 500
    for number, line in list(enumerate(lines))[part::PARTS]:
        file = write(tmp_path, number, made(number))
        assert by_us(file) == json.loads(line), file.read_text()


@pytest.mark.skipif(not ros2_packages.are_available(), reason=ros2_packages.REASON)
def test_values_are_those_that_launch_gives(tmp_path: Path) -> None:
    environment = {**os.environ, **ros2_packages.environment(tmp_path / "packages")}
    files = [write(tmp_path, number, made(number)) for number in range(1000, 1100)]
    for file, expected in zip(files, by_launch(files, environment), strict=True):
        assert by_us(file) == expected, file.read_text()


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
    value = f'<param name="r" value="$({substitution})" type="str"/>'
    node = f'<node exec="/bin/true" name="n">{value}</node>'
    (found,) = by_us(write(tmp_path, 0, Made(".launch.xml", node))) or [None]
    assert found == [["__node:=n"], {"r": repr(expected)}]
