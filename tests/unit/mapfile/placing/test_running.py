# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a placement runs its nodes: rules, scheduling, cores of others, notices."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.create import create
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import Placement, as_data, check, load_mapfile, resolve
from rmw_manycore_py.mapfile.placing.show import rules_in_words
from rmw_manycore_py.platform.topology import Core
from support import MAPFILES
from support.samples.node_source import node_source

pytestmark = pytest.mark.unit

Write = Callable[[str], Path]
SHIPPED = [
    path for path in sorted(MAPFILES.glob("*.yaml")) if not path.name.endswith(".params.yaml")
]
LAUNCH = """\
from launch import LaunchDescription
from launch.actions import ExecuteProcess, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit

def process(name, **options):
    return ExecuteProcess(cmd=["true"], name=name, **options)

def generate_launch_description():
    first = process("first", respawn=True, respawn_delay=2.0, respawn_max_retries=5)
    return LaunchDescription([
        first,
        TimerAction(period=1.5, actions=[process("late")]),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[process("after")])),
    ])
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    (tmp_path / "talker.py").write_text(node_source())

    def write_text(text: str) -> Path:
        (tmp_path / "map.yaml").write_text(text)
        return tmp_path / "map.yaml"

    return write_text


@pytest.fixture
def launched(write: Write, tmp_path: Path) -> Callable[..., Path]:
    def write_nodes(first: str = "") -> Path:
        (tmp_path / "demo.launch.py").write_text(LAUNCH)
        return write(
            "launch_path: demo.launch.py\nnodes:\n"
            f"  first: {{cluster: 1{first}}}\n  late: {{cluster: 1}}\n  after: {{cluster: 1}}\n"
        )

    return write_nodes


def by_name(placement: Placement) -> dict[str, dict[str, Any]]:
    return {node["name"]: node for node in as_data(placement)["nodes"]}


def test_rules_of_a_launch_file_are_shown(launched: Callable[..., Path], tmp_path: Path) -> None:
    placement = check(launched())
    nodes = by_name(placement)
    assert nodes["first"]["respawn"] == {"delay_s": 2.0, "max_retries": 5}
    assert nodes["late"]["start"] == {"delay_s": 1.5, "after": None, "on": None}
    assert nodes["after"]["start"] == {"delay_s": 0.0, "after": "first", "on": "exit"}
    words = {node.name: rules_in_words(node) for node in placement.nodes}
    assert words == {
        "first": ["respawned 2 s after it ends, 5 times at most"],
        "late": ["starts 1.5 s after the others"],
        "after": ["starts after the end of first"],
    }
    shown = CliRunner().invoke(cli, ["map", "show", str(tmp_path / "map.yaml")])
    assert all(word in shown.output for each in words.values() for word in each)
    create(tmp_path / "map.yaml", tmp_path / "out")
    script = (tmp_path / "out/nodes/late.sh").read_text()
    assert "# With manycore run: starts 1.5 s after the others.\n" in script
    created = CliRunner().invoke(
        cli, ["create", str(tmp_path / "map.yaml"), "-o", str(tmp_path / "out"), "--json"]
    )
    assert json.loads(created.stdout)["nodes"] == as_data(placement)["nodes"]


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (", respawn: false", None),
        (", respawn: true", {"delay_s": 1.0, "max_retries": None}),
        (", respawn: {max_retries: 3}", {"delay_s": 1.0, "max_retries": 3}),
    ],
)
def test_a_mapfile_overrules_the_respawn_of_a_launch_file(
    launched: Callable[..., Path], written: str, expected: object
) -> None:
    assert by_name(check(launched(written)))["first"]["respawn"] == expected


def test_a_mapfile_says_whose_end_stops_the_run(launched: Callable[..., Path]) -> None:
    nodes = by_name(check(launched(", ends_run: true")))
    assert [name for name, node in nodes.items() if node["ends_run"]] == ["first"]


def test_a_launch_file_shuts_down_before_it_respawns(
    launched: Callable[..., Path], tmp_path: Path
) -> None:
    mapfile, text = launched(), f"from launch.actions import Shutdown\n{LAUNCH}"
    text = text.replace("respawn=True", "respawn=True, on_exit=Shutdown()")
    (tmp_path / "demo.launch.py").write_text(text)
    first = by_name(check(mapfile))["first"]
    assert (first["ends_run"], first["respawn"]) == (True, None)


def test_nodes_get_cores_that_no_other_run_has(write: Write) -> None:
    mapfile = load_mapfile(
        write("nodes:\n  a: {cluster: 1, script: talker.py}\n  b: {cluster: 1, command: 'true'}\n")
    )
    placement = resolve(mapfile, occupied={Core(1, 1), Core(1, 3)})
    assert [node.place for node in placement.nodes] == [Core(1, 2), Core(1, 4)]
    text = "nodes:\n  a: {cluster: 1, core: 3, script: talker.py}\n"
    with pytest.raises(MapfileError, match=r"a\.core: expected a core that no node on the platf"):
        resolve(load_mapfile(write(text)), occupied={Core(1, 3)})
    shared = load_mapfile(write(f"allow_shared_cores: true\n{text}"))
    assert resolve(shared, occupied={Core(1, 3)}).nodes[0].place == Core(1, 3)


def crossing(write: Write, line: str, keys: str = "") -> tuple[str, ...]:
    type_name = "std_msgs/msg/String"
    node = f"cluster: 1\n    script: talker.py\n    {keys}\n    topic_to: {{{line}}}"
    text = f"nodes:\n  a:\n    {node}\n"
    placement = check(write(text.replace("TYPE", type_name)))
    return tuple(notice for notice in placement.notices if "topic_to" in notice)


@pytest.mark.parametrize("last", ["", "if __name__ == '__main__':\n    main()\n"])
def test_a_module_that_only_defines_something_is_named(
    write: Write, tmp_path: Path, last: str
) -> None:
    (tmp_path / "node.py").write_text(f"def main():\n    pass\n\n\n{last}")
    placement = check(write("nodes:\n  a: {cluster: 1, module: node}\n"))
    found = [notice for notice in placement.notices if "node starts nothing" in notice]
    assert len(found) == (0 if last else 1)
    assert all("map.yaml:2: nodes.a.module" in notice for notice in found)


def test_a_topic_that_no_source_publishes_is_named(write: Write, tmp_path: Path) -> None:
    (notice,) = crossing(write, "/chatters: TYPE")
    place = f"{tmp_path / 'map.yaml'}:6: nodes.a.topic_to"
    assert notice == f"{place}: no source publishes /chatters; did you mean '/chatter'?"
    assert crossing(write, "/chatter: TYPE") == ()
    assert crossing(write, "/chat*: ") == ()
    assert crossing(write, "/news: TYPE", "remappings: {chatter: /news}") == ()
    assert crossing(write, "/other: TYPE", "publish: {/other: std_msgs/msg/String}") == ()
    (tmp_path / "talker.py").write_text(node_source(topic="sys.argv[1]"))
    assert crossing(write, "/chatters: TYPE") == (), "its source does not show all topics"
    (tmp_path / "talker.py").write_text(f"{node_source()}        Outputs(self)\n")
    assert crossing(write, "/chatters: TYPE") == (), "other code may publish on the node"


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_topics_of_shipped_mapfiles_have_sources(path: Path) -> None:
    assert [notice for notice in check(path).notices if "no source publishes" in notice] == []
