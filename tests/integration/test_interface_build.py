# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Definition packages built with the real generators and compilers, and used by real nodes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import arranged
from support import IS_MANYCORE
from support.installs.building import (
    DEFINITIONS,
    HEARD,
    THINGS,
    interface,
    node_command,
    write_definitions,
)
from support.nodes.bridging import OUTSIDE
from support.processes.commands import manycore_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.long,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

MAPFILE = """\
nodes:
  reader: {script: reader.py, cluster: 1}
"""
READER = """\
from things_msgs.msg import Part

print("part", Part(number=3), flush=True)
"""


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_definitions(tmp_path_factory.mktemp("sources"), DEFINITIONS)


@pytest.fixture(scope="module")
def built(sources: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of programs that find the package, and std_srvs built again."""
    env = {**os.environ, "MANYCORE_INTERFACES": str(tmp_path_factory.mktemp("built"))}
    again = Path(sys.prefix) / "share/std_srvs"
    done = interface("build", sources / THINGS, again, env=env)
    assert "things_msgs: 5 definitions in " in done.stdout
    assert "notice: programs use the 'std_srvs' that is installed" in done.stderr
    return env


@pytest.fixture
def here(built: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the programs of the test find the package."""
    monkeypatch.setenv("MANYCORE_INTERFACES", built["MANYCORE_INTERFACES"])


@pytest.mark.parametrize("rmw", ["rmw_manycore", "rmw_fastrtps_cpp"])
def test_nodes_use_the_types(start, here, rmw: str) -> None:
    answerer = start(node_command("answer"), 1, RMW_IMPLEMENTATION=rmw)
    asker = start(node_command("ask"), 2, RMW_IMPLEMENTATION=rmw)
    asker.wait_for("counted 2")
    asker.wait_for(r"collected \[0, 1, 2\]")
    answerer.wait_for(HEARD)


def test_messages_cross_the_bridge_to_fast_dds(start, here, bridge) -> None:
    route = bridge.route("outward", "/things", f"{THINGS}/msg/Thing")
    bridge.run_unforked(Plan(bridge.platform, arranged([route], 1)), "outward")
    start(node_command("say"), 1)
    outside = start(node_command("answer"), **OUTSIDE)
    outside.wait_for(HEARD)


def test_tools_know_the_types(start, here, built: dict[str, str]) -> None:
    start(node_command("say"), 1).wait_for("saying")
    echo = start(manycore_command("topic", "echo", "--once", "/things"))
    echo.wait_for("number: 200")
    assert echo.wait() == 0
    shown = interface("show", f"{THINGS}/msg/Thing", "--no-comments", env=built).stdout
    assert shown.splitlines()[-3:-1] == ["\tint32 number", "\tint32[<=4] few"]
    assert f"{THINGS}/action/Collect" in interface("list", env=built).stdout
    assert "wstring text" in interface("show", f"{THINGS}/msg/Mark", env=built).stdout


def test_a_second_build_has_nothing_to_do(sources: Path, built: dict[str, str]) -> None:
    before = Path(built["MANYCORE_INTERFACES"])
    view = os.readlink(next(before.glob("*/current")))
    done = interface("build", sources, env=built)
    assert done.stdout == "things_msgs: 5 definitions, built before\n"
    assert os.readlink(next(before.glob("*/current"))) == view


def test_types_built_again_have_the_hashes_of_the_installed_ones(built: dict[str, str]) -> None:
    installed = Path(sys.prefix) / "share/std_srvs/srv"
    again = next(Path(built["MANYCORE_INTERFACES"]).glob("*/store/std_srvs-*/share/std_srvs/srv"))
    descriptions = sorted(file.name for file in installed.glob("*.json"))
    assert len(descriptions) == 3
    for name in descriptions:
        texts = [(directory / name).read_text() for directory in (installed, again)]
        assert json.loads(texts[0]) == json.loads(texts[1])


def test_list_shows_which_package_wins(built: dict[str, str]) -> None:
    rows = json.loads(interface("list", "--built", "--json", env=built).stdout)
    states = {row["package"]: row["state"] for row in rows}
    assert states == {THINGS: "this one", "std_srvs": f"the one installed in {sys.prefix}"}
    code = "import std_srvs; print(std_srvs.__file__)"
    found = subprocess.check_output([sys.executable, "-c", code], env=built, text=True)
    assert found.startswith(sys.prefix)


def test_a_mapfile_selects_what_is_built(start, sources, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("MANYCORE_INTERFACES", str(tmp_path / "built"))
    (tmp_path / "map.yaml").write_text(MAPFILE)
    (tmp_path / "reader.py").write_text(READER)
    env = dict(os.environ)
    done = interface("build", sources, "--mapfile", tmp_path / "map.yaml", env=env)
    assert "things_msgs: 1 definition in " in done.stdout
    # An action generates ten structures, a service three, a message one.
    assert done.stdout.endswith("; left out 4 of 5, 94% of the code\n")
    run = start(manycore_command("run", tmp_path / "map.yaml"))
    run.wait_for(r"part things_msgs\.msg\.Part\(number=3")
    # A later build of other types does not remove these.
    done = interface("build", sources, "--only", f"{THINGS}/msg/Mark", env=env)
    assert "things_msgs: 2 definitions in " in done.stdout
    assert interface("package", THINGS, env=env).stdout.split() == [
        f"{THINGS}/msg/Mark",
        f"{THINGS}/msg/Part",
    ]
