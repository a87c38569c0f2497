# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Routes of a machine, names of what is measured, box plots, and input that is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from rmw_manycore_py.bench.box_plot import Boxes, draw_boxes
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.thesis.matrix.cases import cases
from rmw_manycore_py.papers.thesis.noc.cases import SIZES, Setting, size_name
from rmw_manycore_py.papers.thesis.noc.figures import figures
from rmw_manycore_py.papers.thesis.noc.routes import Placement, chosen, main_route, routes
from rmw_manycore_py.picture.plotting import load_figure
from support.samples.sysfs import description_of, write_sysfs

pytestmark = pytest.mark.unit


def test_each_kind_of_route_is_there_once(tmp_path: Path) -> None:
    system = write_sysfs(description_of("epyc_9654_2s"), tmp_path)
    found = routes(range(384), system)
    assert {name: place.receiver for name, place in found.items()} == {
        "same CPU": 0,
        "same core": 192,
        "same cluster": 1,
        "same NUMA node": 8,
        "other NUMA node": 96,
    }
    assert main_route(found) == "same core"
    assert {place.uc for place in found.values()} == {1, 2}
    assert list(routes((0, 100), system)) == ["same CPU", "other NUMA node"]


def test_a_machine_without_topology_has_two_routes(tmp_path: Path) -> None:
    assert list(routes((0, 1), tmp_path)) == ["same CPU", "same cluster"]
    assert routes((3,), tmp_path) == {"same CPU": Placement(3, 3, 3)}


def test_the_uc_is_beside_the_receiver_where_no_cpu_is_free() -> None:
    assert chosen("0,1", (0, 1)) == {"CPU 0,1": Placement(0, 1, 1)}
    assert chosen("0,1", (0, 1, 5)) == {"CPU 0,1": Placement(0, 1, 5)}
    assert chosen("0,1,0", (0, 1)) == {"CPU 0,1,0": Placement(0, 1, 0)}


@pytest.mark.parametrize("text", ["", "0", "0,x", "0,1,0,1", "0,9", "-1,0"])
def test_cpus_that_are_none_are_refused(text: str) -> None:
    with pytest.raises(ManycoreError, match=r"expected sender,receiver.* of the host CPUs 0, 1"):
        chosen(text, (0, 1))


def test_sizes_are_named_as_in_the_thesis() -> None:
    names = [size_name(size) for size in SIZES]
    assert names == ["100 B", "1 KB", "10 KB", "100 KB", "1 MB"]
    assert size_name(4096) == "4096 B"


def test_the_figures_have_all_their_series() -> None:
    names = [case.name for case in cases((400, 280))]
    assert len(names) == len(set(zip((c.question for c in cases((400, 280))), names, strict=True)))
    assert sum(case.n == 280 for case in cases((400, 280))) == 2 * (4 + 4 + 5) + 5
    assert sum(case.n == 400 for case in cases((400, 280))) == 4 + 5


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("noc", "--size", "0"), "--size 0: expected 1 to 2097152 bytes"),
        (("noc", "--size", str(10**18)), "expected 1 to 2097152 bytes"),
        (("noc", "--size", "-5", "--model", "bostan"), "--size -5: expected"),
        (("noc", "--cpus", "0,4096"), "--cpus 0,4096: expected sender,receiver"),
        (("noc", "--cpus", "0,0", "--model", "bostan"), "--cpus is for this machine"),
        (("matrix", "--n", "1"), "--n 1: expected 2 to 1024"),
        (("matrix", "--n", "100000", "--model", "bostan"), "--n 100000: expected 2 to 1024"),
        (("matrix", "--model", "coolidge"), "'coolidge' is not 'bostan'"),
    ],
)
def test_bad_input_is_an_error(arguments: tuple[str, ...], message: str) -> None:
    result = CliRunner().invoke(cli, ["bench", *arguments])
    assert result.exit_code == 2
    assert message in result.output + str(result.exception)


@pytest.mark.needs("matplotlib")
def test_boxes_are_drawn_on_both_axes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    figure = load_figure()
    monkeypatch.setattr(figure, "savefig", lambda self, path: drawn.append(self))
    series = {"Tx": {"100 B": [1.0, 2.0, 3.0], "1 KB": [4.0]}, "UC": {"1 KB": [5.0, 6.0]}}
    draw_boxes(Boxes("title", "size", "us", ["100 B", "1 KB"], series), tmp_path / "boxes.svg")
    panels = drawn[0].axes
    assert [panel.get_yscale() for panel in panels] == ["log", "linear"]
    for panel in panels:
        assert len(panel.patches) == 3
        assert [label.get_text() for label in panel.get_xticklabels()] == ["100 B", "1 KB"]


@pytest.mark.needs("matplotlib")
def test_only_figures_with_results_are_drawn(tmp_path: Path) -> None:
    setting = Setting(("direct",), "direct", "between")
    results = [Result("transfer of 100 B", "UC from IO SMEM, direct", "us", (1.0, 2.0))]
    written = figures(setting, (100,), "here")(results, tmp_path)
    assert [path.name for path in written] == ["figure_4_5.svg", "figure_4_6_and_4_7.svg"]
    assert all("<svg" in path.read_text() for path in written)
