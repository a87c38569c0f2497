# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Components, event handlers, timers, environment: the content of launch files besides nodes."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.launch_file import LaunchFile, Respawn, Start, read_launch_file
from support import TIMEOUT_S

pytestmark = pytest.mark.unit

ABSENT = (
    "expected the package 'absent', found that it is not installed: "
    "pip install ./absent, or source its workspace"
)

Read = Callable[..., LaunchFile]
HEAD = """\
import os
import launch
from launch import LaunchDescription, SomeSubstitutionsType
from launch.actions import *
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessStart, OnShutdown
from launch.events import Shutdown as ShutdownEvent, matches_action
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import ComposableNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.substitutions import FindPackageShare
import lifecycle_msgs.msg

def node(executable, **described):
    return Node(package="p", executable=executable, **described)
"""


@pytest.fixture
def read(tmp_path: Path) -> Read:
    def read_text(text: str, name: str = "demo.launch.xml", **arguments: str) -> LaunchFile:
        file = tmp_path / name
        file.write_text(text)
        return read_launch_file(file, arguments)

    return read_text


@pytest.fixture
def read_python(read: Read) -> Read:
    def read_actions(actions: str, before: str = "") -> LaunchFile:
        body = f"def generate_launch_description():\n    {before}\n    return LaunchDescription"
        # `import *` imports what the stand-ins define, as there is no __all__.
        return read(f"{HEAD}{body}([{actions}])\n", "demo.launch.py")

    return read_actions


def test_components_are_those_of_their_container_wherever_they_are_loaded(read: Read) -> None:
    launch = read(
        """<launch><arg name="eyes" default="false"/>
        <group><push-ros-namespace namespace="left"/><set_remap from="a" to="b"/>
          <node_container pkg="demo" exec="component_container" name="box" namespace="">
            <composable_node pkg="p" plugin="p::Camera" name="camera">
              <param name="rate" value="5"/><param name="small" value="1e-9"/>
              <remap from="image" to="raw"/>
              <extra_arg name="use_intra_process_comms" value="true"/>
            </composable_node>
            <composable_node pkg="p" plugin="p::Eye" name="eye" if="$(var eyes)"/>
          </node_container>
        </group>
        <load_composable_node target="/left/box">
          <composable_node pkg="p" plugin="p::Lens" name="lens" namespace="right"/>
        </load_composable_node>
        <load_composable_node target="elsewhere">
          <composable_node pkg="p" plugin="p::Ear" name="ear"/>
        </load_composable_node></launch>"""
    )
    (box,) = launch.nodes
    camera, lens = box.components
    assert (box.label, box.namespace) == ("box", "/left")
    assert (camera.namespace, camera.name, camera.plugin) == ("/left", "camera", "p::Camera")
    assert camera.parameters == ({"rate": 5}, {"small": "1e-9"})  # as text in a LoadNode request
    assert camera.remappings == (("a", "b"), ("image", "raw"))
    assert camera.extra_arguments == ({"use_intra_process_comms": True},)
    assert (lens.namespace, lens.remappings) == ("/right", ())
    (notice,) = launch.notices
    assert notice.endswith(": 'ear' is not loaded: no container /elsewhere is started here")


def test_components_in_python(read_python: Read) -> None:
    launch = read_python(
        "box, LoadComposableNodes(target_container=box, composable_node_descriptions=["
        "ComposableNode(package='p', plugin='p::Lens', parameters=[{'x': 1}])])",
        "box = ComposableNodeContainer(package='p', executable='e', name='box', namespace='n')",
    )
    (box,) = launch.nodes
    (lens,) = box.components
    assert (lens.label, lens.name, lens.parameters) == ("Lens", None, ({"x": 1},))


def test_handlers_say_what_a_process_waits_for(read_python: Read) -> None:
    launch = read_python(
        "RegisterEventHandler(OnProcessExit(target_action=one, on_exit=[node('two')])), one,"
        "TimerAction(period=2.5, actions=[node('three')]),"
        "RegisterEventHandler(OnProcessStart(target_action=one, on_start=["
        "    TimerAction(period=1.0, actions=[node('four')])])),"
        "RegisterEventHandler(OnExecutionComplete(target_action=done, on_completion=node('five'))),"
        "done, RegisterEventHandler(OnShutdown(on_shutdown=[node('never')]))",
        "one, done = node('one'), LogInfo(msg='done')",
    )
    serials = {one.label: one.serial for one in launch.nodes}
    assert {one.label: one.start for one in launch.nodes} == {
        "one": Start(),
        "two": Start(after=serials["one"], on_exit=True),
        "three": Start(delay_s=2.5),
        "four": Start(delay_s=1.0, after=serials["one"]),
        "five": Start(),
    }
    assert [n.rpartition(": ")[2] for n in launch.notices] == [
        "done",
        "what is done on shutdown has no effect here",
    ]


@pytest.mark.parametrize(
    "on_exit", ["Shutdown()", "[EmitEvent(event=ShutdownEvent(reason='over'))]"]
)
def test_a_process_may_end_the_run_and_be_started_again(read_python: Read, on_exit: str) -> None:
    launch = read_python(
        f"node('ends', on_exit={on_exit}),"
        "node('stays', respawn=True, respawn_delay=1.5, prefix=['nice -n 5']),"
        "ExecuteProcess(cmd=['echo a', '| cat'], shell=True, cwd='/')"
    )
    ends, stays, shell = launch.nodes
    assert (ends.ends_run, stays.ends_run) == (True, False)
    assert (ends.respawn, stays.respawn) == (None, Respawn(1.5, -1))
    assert stays.prefix == ("nice", "-n", "5")
    assert (shell.command, shell.cwd) == (("/bin/sh", "-c", "echo a | cat"), "/")
    assert shell.label == "echo"


def test_lifecycle_nodes_are_brought_through_their_transitions(read_python: Read) -> None:
    launch = read_python(
        "EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(one),"
        "          transition_id=lifecycle_msgs.msg.Transition.TRANSITION_CONFIGURE)),"
        "one, RegisterEventHandler(OnStateTransition(target_lifecycle_node=one,"
        "    goal_state='inactive', entities=[EmitEvent(event=ChangeState("
        "        lifecycle_node_matcher=matches_action(one), transition_id=3))])),"
        "LifecycleNode(package='p', executable='two', name='two', namespace='', autostart=True)",
        "one = LifecycleNode(package='p', executable='one', name='one', namespace='')",
    )
    assert [one.transitions for one in launch.nodes] == [(1, 3), (1, 3)]


def test_the_environment_is_extended(read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KNOWN", "before")
    launch = read(
        '<launch><append_env name="KNOWN" value="after"/><append_env name="KNOWN" value="first" '
        'prepend="true" separator="+"/><append_env name="NEW" value="x"/>'
        '<node pkg="p" exec="e"/><unset_env name="NEW"/><node pkg="p" exec="f"/></launch>'
    )
    first, second = launch.nodes
    assert first.env == {"KNOWN": "first+before:after", "NEW": "x"}
    assert second.env == {"KNOWN": "first+before:after"}


def test_what_a_launch_file_changes_in_its_process(
    read_python: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Variables are kept, as launch keeps them for nodes; all else ends with the process."""
    for name in ("CHANGED", "REMOVED"):
        monkeypatch.setenv(name, "before")
    monkeypatch.setenv("ADDED", "")
    modules = set(sys.modules)
    lines = (
        "import http.server",
        "os.environ.update(CHANGED='after', ADDED='x')",
        "del os.environ['REMOVED']",
        "os.chdir('/')",
        "class Name(str): pass",
        "class Level(int): pass",
    )
    actions = "node('e', arguments=[Name('a')], parameters=[{'level': Level(3)}])"
    launch = read_python(actions, "\n    ".join(lines))
    (node,) = launch.nodes
    assert node.arguments == ("a",)
    assert node.parameters == ({"level": 3},)
    assert (os.environ["CHANGED"], os.environ["ADDED"]) == ("after", "x")
    assert "REMOVED" not in os.environ
    assert os.getcwd() != "/"
    assert "http.server" not in set(sys.modules) - modules


def test_a_process_that_a_launch_file_leaves_delays_nothing(
    read_python: Read, tmp_path: Path
) -> None:
    waited = tmp_path / "waited"
    lines = (
        "pid = os.fork()",
        "if pid == 0:",
        f"    import time; time.sleep({TIMEOUT_S}); open({str(waited)!r}, 'w'); os._exit(0)",
    )
    launch = read_python("node('e', arguments=[str(pid)])", "\n    ".join(lines))
    assert not waited.exists()
    (node,) = launch.nodes
    os.kill(int(node.arguments[0]), signal.SIGKILL)


def test_paths_and_contents_of_files(read_python: Read, tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text("<robot/>")
    launch = read_python(
        "node('e', arguments=[PathSubstitution(here) / 'a' / ['b', '.yaml']]),"
        "node('f', parameters=[{'urdf': FileContent(PathJoinSubstitution([here, 'robot.urdf']))}])",
        "here = ThisLaunchFileDir()",
    )
    assert launch.nodes[0].arguments == (f"{tmp_path}/a/b.yaml",)
    assert launch.nodes[1].parameters == ({"urdf": "<robot/>"},)


def test_several_nodes_of_one_name_are_numbered(read: Read) -> None:
    nodes = '<node pkg="p" exec="spawner.py" args="{}"/>'
    launch = read(f"<launch>{nodes.format(1)}{nodes.format(2)}{nodes.format(3)}</launch>")
    assert [one.label for one in launch.nodes] == ["spawner", "spawner_2", "spawner_3"]


def test_what_is_not_installed_concerns_only_what_needs_it(tmp_path: Path, read: Read) -> None:
    launch = read(
        """<launch><arg name="config" default="$(find-pkg-share absent)/config"/>
        <node pkg="p" exec="e" args="$(var config)/a.yaml"/>
        <include file="$(find-pkg-share absent)/other.launch.xml"/>
        <executable cmd="sh -c true" name="runs"/></launch>"""
    )
    e, runs = launch.nodes
    assert e.problem is not None
    assert runs.problem is None
    assert [n.partition("demo.launch.xml:")[2] for n in launch.notices] == [
        f"2: cannot run here: {ABSENT}",
        f"3: cannot run here: {ABSENT}",
    ]
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("launch_path: demo.launch.xml\nnodes: {runs: {cluster: 1}}\n")
    assert [node.name for node in check(mapfile).nodes] == ["runs"]
    mapfile.write_text("launch_path: demo.launch.xml\nnodes: {e: {cluster: 1}}\n")
    with pytest.raises(MapfileError, match=rf"xml:2: {ABSENT}"):
        check(mapfile)


def test_modules_that_use_launch_get_the_stand_ins_while_a_file_is_read(
    tmp_path: Path, read: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "own_substitutions.py").write_text(
        "from typing import Dict\n"
        "import launch\n"
        "from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions\n"
        "class Upper(launch.Substitution):\n"
        "    def __init__(self, text: launch.SomeSubstitutionsType) -> None:\n"
        "        super().__init__()\n"
        "        self.text = normalize_to_list_of_substitutions(text)\n"
        "    def perform(self, context: launch.LaunchContext) -> str:\n"
        "        return perform_substitutions(context, self.text).upper()\n"
    )
    text = (
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n"
        "from own_substitutions import Upper\n"
        "def generate_launch_description():\n"
        "    node = Node(package='p', executable='e', name=Upper(['a', 'b']))\n"
        "    return LaunchDescription([node])\n"
    )
    for _ in range(2):
        (node,) = read(text, "demo.launch.py").nodes
        assert node.name == "AB"
        assert "own_substitutions" not in sys.modules


def test_a_node_without_a_name_keeps_its_own(tmp_path: Path, read: Read) -> None:
    read('<launch><node exec="sh"/><node exec="sh" name="named"/></launch>')
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        "launch_path: demo.launch.xml\nnodes: {sh: {cluster: 1}, named: {cluster: 1}}\n"
    )
    own, named = check(mapfile).nodes
    assert not [word for word in own.argv if word.startswith("__node")]
    assert "__node:=named" in named.argv


def test_a_launch_file_makes_conditions_of_its_own(read_python: Read) -> None:
    launch = read_python(
        "node('a', condition=Condition(predicate=lambda context: True)),"
        "node('b', condition=Condition()), node('c', condition=Not(one)),"
        "OpaqueFunction(function=lambda context: [node(str(one._predicate_func(context)))])",
        "from launch import Condition\n"
        "    from launch.conditions import IfCondition\n"
        "    class Not(IfCondition):\n"
        "        def __init__(self, other):\n"
        "            Condition.__init__(self, predicate=lambda c: not other.evaluate(c))\n"
        "    one = IfCondition('true')",
    )
    assert [one.label for one in launch.nodes] == ["a", "True"]
