# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fig. 12 of ROS-lite2: its formula, and the installed mapfiles in it."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.create.figure import FILE, PAPERS_REDUCTION, by_hand, dot_of
from support import MAPFILES

pytestmark = pytest.mark.unit


def test_lines_by_hand_are_those_of_the_papers_formula() -> None:
    lines = by_hand()
    assert (lines[0], lines[1], lines[50]) == (0, 10 + 15 + 6 * 15, 5750)


def test_the_papers_set_of_nodes_takes_fewer_lines_than_in_the_paper() -> None:
    """Return the figures stated in docs/reference/benchmarks/reference_system.md."""
    dot = dot_of(MAPFILES / "autoware_reference.yaml")
    assert (dot.nodes, dot.written_lines, dot.delta_loc) == (24, 76, 626)
    assert round(dot.reduction, 2) == 0.88 > PAPERS_REDUCTION


@pytest.mark.needs("matplotlib")
def test_the_report_is_of_the_mapfile_and_compares_on_request(tmp_path: Path) -> None:
    mapfile = MAPFILES / "talker_listener.yaml"
    words = ("create", str(mapfile), "-o", str(tmp_path), "--report", "--json")
    own = CliRunner().invoke(cli, words)
    assert [dot["name"] for dot in json.loads(own.stdout)["figure"]] == ["talker_listener"]
    done = CliRunner().invoke(cli, (*words, "--compare"))
    assert done.exit_code == 0, done.output
    dots = {dot["name"]: dot for dot in json.loads(done.stdout)["figure"]}
    assert {"talker_listener", "autoware_reference", "three_nodes", "three_nodes.map"} <= set(dots)
    assert dots["autoware_reference"]["delta_loc"] == 626
    assert ElementTree.parse(tmp_path / FILE).getroot().tag.endswith("svg")
