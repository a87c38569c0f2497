# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plans: mapfiles of nodes that need not be installed."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, MapfileError
from rmw_manycore_py.mapfile import check, init, load_mapfile, resolve

pytestmark = pytest.mark.unit

LAUNCH = """\
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import Command
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare
from no_moveit import Builder


def generate_launch_description():
    lens = ComposableNode(package='p', plugin='p::Lens', name='lens')
    return LaunchDescription([
        Node(executable='sh', name='here'),
        Node(package='absent', executable='driver', name='driver', namespace='left'),
        Node(package='absent', executable='driver', name='driver', namespace='right'),
        Node(executable='sh', name='urdf', parameters=[{'x': Command('no_such_xacro')}]),
        Node(executable='sh', name='moveit', parameters=[Builder('r').to_dict()]),
        ComposableNodeContainer(package='q', executable='container', name='box', namespace='',
                                composable_node_descriptions=[lens]),
        IncludeLaunchDescription([FindPackageShare('nav2'), '/other.launch.py']),
    ])
"""
NODES = ["here", "/left/driver", "/right/driver", "urdf", "moveit", "box"]


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    """Return a plan of the launch file above."""
    launch = tmp_path / "robot.launch.py"
    launch.write_text(LAUNCH)
    mapfile = tmp_path / "plan.yaml"
    mapfile.write_text(init([launch], tmp_path, plan=True))
    return mapfile


def manycore(*words: str) -> Result:
    return CliRunner().invoke(cli, words)


def test_a_plan_has_all_nodes_and_comments_on_what_is_missing(plan: Path) -> None:
    text = plan.read_text()
    assert [node.name for node in check(plan).nodes] == NODES
    comments = [line.strip() for line in text.splitlines() if "#" in line and "choose" not in line]
    missing = (
        "expected the package '{0}', found that it is not installed: "
        "pip install ./{0}, or source its workspace"
    )
    assert comments == [
        "# Choose the clusters. A node gets the first free core unless 'core' is set.",
        "plan: true  # nodes need not be installed for map check and map show; run needs them",
        f"# robot.launch.py:20: cannot run here: {missing.format('nav2')}",
        f"# cannot run here: robot.launch.py:14: driver: {missing.format('absent')}",
        f"# cannot run here: robot.launch.py:15: driver: {missing.format('absent')}",
        "# cannot run here: robot.launch.py:16: expected a command that runs, found "
        "'no_such_xacro': No such file or directory",
        "# cannot run here: robot.launch.py:17: expected the Python module 'no_moveit', found "
        "that it is not installed",
        "# loads lens",
        f"# cannot run here: robot.launch.py:18: box: {missing.format('q')}",
    ]


def test_checking_a_plan_reports_what_is_missing(plan: Path) -> None:
    checked = manycore("map", "check", str(plan))
    assert checked.exit_code == 0
    assert checked.output.splitlines()[-2] == "a plan: 5 of 6 nodes cannot run here"
    assert "/urdf cannot run here: expected a command that runs" in checked.output
    valid = json.loads(manycore("map", "check", "--json", str(plan)).output)
    assert (valid["valid"], list(valid["missing"])) == (
        True,
        ["/left/driver", "/right/driver", "/urdf", "/moveit", "/box"],
    )


def test_showing_a_plan_reports_what_is_missing(plan: Path) -> None:
    shown = json.loads(manycore("map", "show", "--json", str(plan)).output)["nodes"]
    assert [bool(node["command"]) for node in shown] == [True] + [False] * 5
    assert shown[1]["missing"].startswith("expected the package 'absent'")
    assert (
        "that it is not installed: pip install ./absent, or source its workspace"
        in manycore("map", "show", str(plan)).output
    )


def test_running_a_plan_fails(plan: Path) -> None:
    assert manycore("run", str(plan)).exit_code == EXIT_BAD_INPUT
    with pytest.raises(MapfileError) as caught:
        resolve(load_mapfile(plan))
    assert [problem.line for problem in caught.value.problems] == [14, 15, 16, 17, 18]


def test_a_plan_of_what_is_installed_runs(tmp_path: Path) -> None:
    launch = tmp_path / "robot.launch.xml"
    launch.write_text('<launch><node exec="sh" name="here"/></launch>')
    mapfile = tmp_path / "plan.yaml"
    mapfile.write_text(init([launch], tmp_path, plan=True))
    (node,) = resolve(load_mapfile(mapfile)).nodes
    assert os.path.basename(node.argv[0]) == "sh"
    assert node.missing == ""


def test_other_mistakes_of_a_plan_are_errors(plan: Path) -> None:
    text = plan.read_text()
    plan.write_text(text.replace("cluster: 1", "cluster: 9", 1))
    with pytest.raises(MapfileError, match=r"nodes.here.cluster: expected 1 to 5"):
        check(plan)
    plan.write_text(text.replace("  box:", "  crate:"))
    with pytest.raises(MapfileError, match=r"expected a node of robot.launch.py"):
        check(plan)


def test_a_plan_fills_one_cluster_after_the_other(tmp_path: Path) -> None:
    launch = tmp_path / "many.launch.xml"
    nodes = "".join(f'<node pkg="absent" exec="e" name="n{n}"/>' for n in range(71))
    launch.write_text(f"<launch>{nodes}</launch>")
    with pytest.raises(ManycoreError, match="71 nodes are more than the 70 cores of 'coolidge'"):
        init([launch], tmp_path, "coolidge", plan=True)
    mapfile = tmp_path / "plan.yaml"
    mapfile.write_text(init([launch], tmp_path, "bostan", plan=True))
    clusters = [node.cluster for node in check(mapfile).nodes]
    assert clusters == sorted(clusters)
    assert clusters.count(1) == 14


def test_map_init_writes_a_plan(tmp_path: Path) -> None:
    launch = tmp_path / "robot.launch.py"
    launch.write_text(LAUNCH)
    made = manycore("map", "init", "--plan", str(launch), "--profile", "coolidge")
    assert made.exit_code == 0
    assert "platform: coolidge\nplan: true" in made.output


def test_a_plan_without_nodes_reports_what_was_left_out(tmp_path: Path) -> None:
    launch = tmp_path / "robot.launch.xml"
    launch.write_text('<launch><include file="$(find-pkg-share nav2)/a.launch.py"/></launch>')
    with pytest.raises(ManycoreError, match=r"no nodes found in .*\n.*the package 'nav2', found"):
        init([launch], tmp_path, plan=True)
