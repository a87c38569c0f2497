# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Defaults of parameters equal those in the documentation."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.nodes.pointcloud_map_loader import LoaderParameters
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters

pytestmark = pytest.mark.unit

DESIGN = Path(__file__).parents[3] / "docs" / "design"


def rows_below(page: str, heading: str) -> list[list[str]]:
    """Return the cells of the first table below a line that starts so."""
    text = (DESIGN / page).read_text()
    assert f"\n{heading}" in text, heading
    lines = text.split(f"\n{heading}", 1)[1].splitlines()[1:]
    start = next(i for i, line in enumerate(lines) if line.startswith("|"))
    end = next((i for i in range(start, len(lines)) if not lines[i].startswith("|")), len(lines))
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[start:end]]
    return cells[2:]


def written(value: Any) -> str:
    """Return a default in the notation of the documentation."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return f"[{', '.join(written(one) for one in value)}]" if value else ""
    return str(value)


def defaults(*kinds: type) -> dict[str, str]:
    found = {}
    for kind in kinds:
        for field in fields(kind):
            found[field.metadata["name"]] = written(field.metadata["default"])
    return found


def as_number(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text.strip("`")


def test_the_parameters_of_ours():
    rows = rows_below("ndt_interface.md", "Parameters that Autoware does not have:")
    documented = {name.strip("`"): as_number(default) for name, default, _ in rows}
    assert documented == {n: as_number(d) for n, d in defaults(OwnParameters).items()}


def test_the_parameters_of_autoware():
    """Those that differ from Autoware's node are listed, all are counted."""
    rows = rows_below("ndt_autoware.md", "## Parameters")
    documented = {name.strip("`"): as_number(default) for name, default, _ in rows}
    expected = {name: as_number(value) for name, value in defaults(MatcherParameters).items()}
    assert documented.items() <= expected.items()
    page = (DESIGN / "ndt_autoware.md").read_text()
    assert f"The node has {len(expected)} parameters of Autoware's" in page


def test_the_parameters_of_the_map_loader():
    rows = rows_below("ndt_autoware.md", "## Map loader")
    documented = {row[0].strip("`"): as_number(row[1]) for row in rows if row[0].startswith("`")}
    expected = {n: as_number(d) for n, d in defaults(LoaderParameters).items()}
    assert {n: d for n, d in documented.items() if n in expected} == expected


def test_the_levels_of_the_library():
    text = (DESIGN / "ndt.md").read_text()
    found = re.search(r"levels \(`coarse_levels`\) \| (\(.*?\)) two|levels .*\| (\(2,\))", text)
    assert found is not None
    assert MatcherOptions().coarse_levels == (2.0,)
