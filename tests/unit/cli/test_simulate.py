# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What `manycore simulate` refuses, and what it says of nodes without a profile."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.profile.files import save
from support.samples.profiles import pipeline

pytestmark = pytest.mark.unit

MAPFILE = """\
nodes:
  camera: {command: "true", cluster: 1}
  filter: {command: "true", cluster: 1}
  sink: {command: "true", cluster: 2}
"""


@pytest.fixture
def simulate(tmp_path: Path):
    """Return a function that simulates a mapfile of the pipeline."""

    def call(mapfile: str, *options: str) -> Result:
        (tmp_path / "map.yaml").write_text(mapfile)
        save(pipeline(), tmp_path / "app.profile.json")
        paths = (str(tmp_path / "map.yaml"), "--profile", str(tmp_path / "app.profile.json"))
        return CliRunner().invoke(cli, ("simulate", *paths, "--duration", "1", *options))

    return call


def test_nodes_that_the_profile_lacks_are_named(simulate) -> None:
    assert "not in the profile" not in simulate(MAPFILE).output
    more = simulate(f'{MAPFILE}  planner: {{command: "true", cluster: 3}}\n')
    assert more.exit_code == 0
    assert "not in the profile, so simulated as idle: /planner" in more.output


@pytest.mark.parametrize("chain", ["", " "])
def test_a_chain_has_a_topic(simulate, chain: str) -> None:
    result = simulate(MAPFILE, "--chain", chain)
    assert result.exit_code == EXIT_BAD_INPUT
    assert "expected topics separated by spaces, found none" in result.output


def test_loads_of_host_cpus_are_shown(simulate) -> None:
    one_cpu = MAPFILE.replace("cluster: 2", "cluster: 2, host_cpu: 0").replace(
        "cluster: 1", "cluster: 1, host_cpu: 0"
    )
    lines = simulate(one_cpu).output.split("CPUs of this host\n")[1].splitlines()
    assert lines[0].split() == ["CPU", "load"]
    number, load = lines[1].split()
    assert number == "0"
    assert float(load.rstrip("%")) == pytest.approx(33, abs=2)


def test_a_platform_file_with_a_wrong_value_is_named(simulate, tmp_path: Path) -> None:
    file = tmp_path / "slow.yaml"
    file.write_text("base: host\nparameters: {speed: {value: 0, source: chosen}}\n")
    result = simulate(MAPFILE, "--platform", str(file))
    assert result.exit_code == EXIT_BAD_INPUT
    assert f"{file}: parameter speed of a platform: expected more than 0" in result.output


def test_a_simulation_ends(simulate) -> None:
    result = simulate(MAPFILE, "--duration", "inf")
    assert result.exit_code == EXIT_BAD_INPUT
    assert "expected seconds that end, found inf" in result.output
