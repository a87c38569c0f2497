# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Launch files in XML, YAML and Python give the same nodes, without the package launch."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.launch_file import (
    ExpandedFile,
    LaunchedNode,
    LaunchFile,
    command,
    read_launch_file,
)
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.substitutions import perform
from rmw_manycore_py.mapfile.launch_file.text import parse

pytestmark = pytest.mark.unit

Read = Callable[..., LaunchFile]

XML = """\
<launch>
  <arg name="rate_hz" default="2.5"/>
  <arg name="prefix" default="left"/>
  <let name="topic" value="/$(var prefix)/chatter"/>
  <group>
    <push-ros-namespace namespace="$(var prefix)"/>
    <node pkg="demo" exec="talker" name="talker" args="--say 'hello you'">
      <param name="rate_hz" value="$(var rate_hz)"/>
      <param name="label" value="7" type="str"/>
      <remap from="chatter" to="$(var topic)"/>
      <env name="MOOD" value="$(env NO_SUCH_MOOD calm)"/>
    </node>
  </group>
  <node pkg="demo" exec="listener" if="$(eval '$(var rate_hz) > 5')"/>
  <node pkg="demo" exec="listener" unless="$(equals $(var prefix) right)"/>
</launch>
"""

YAML = """\
launch:
  - arg: {name: rate_hz, default: "2.5"}
  - arg: {name: prefix, default: left}
  - let: {name: topic, value: /$(var prefix)/chatter}
  - group:
      - push-ros-namespace: {namespace: $(var prefix)}
      - node:
          pkg: demo
          exec: talker
          name: talker
          args: --say 'hello you'
          param:
            - {name: rate_hz, value: $(var rate_hz)}
            - {name: label, value: "7", type: str}
          remap:
            - {from: chatter, to: $(var topic)}
          env:
            - {name: MOOD, value: $(env NO_SUCH_MOOD calm)}
  - node: {pkg: demo, exec: listener, if: "$(eval '$(var rate_hz) > 5')"}
  - node: {pkg: demo, exec: listener, unless: "$(equals $(var prefix) right)"}
"""

PYTHON = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, SetLaunchConfiguration
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import (
    EnvironmentVariable, EqualsSubstitution, LaunchConfiguration, PythonExpression
)
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    rate_hz = LaunchConfiguration("rate_hz")
    prefix = LaunchConfiguration("prefix")
    talker = Node(
        package="demo",
        executable="talker",
        name="talker",
        arguments=["--say", "hello you"],
        parameters=[{"rate_hz": rate_hz, "label": ParameterValue("7", value_type=str)}],
        remappings=[("chatter", LaunchConfiguration("topic"))],
        additional_env={"MOOD": EnvironmentVariable("NO_SUCH_MOOD", default_value="calm")},
        output="screen",
    )
    fast = IfCondition(PythonExpression([rate_hz, " > 5"]))
    left = UnlessCondition(EqualsSubstitution(prefix, "right"))
    return LaunchDescription([
        DeclareLaunchArgument("rate_hz", default_value="2.5", description="How often"),
        DeclareLaunchArgument("prefix", default_value="left"),
        SetLaunchConfiguration("topic", ["/", prefix, "/chatter"]),
        GroupAction([PushRosNamespace(prefix), talker]),
        Node(package="demo", executable="listener", condition=fast),
        Node(package="demo", executable="listener", condition=left),
    ])
"""

ALL = [("demo.launch.xml", XML), ("demo.launch.yaml", YAML), ("demo.launch.py", PYTHON)]


COMPARED = (
    *("name", "namespace", "package", "executable", "command", "remappings", "arguments"),
    *("ros_arguments", "env"),
)


@pytest.fixture
def read(tmp_path: Path) -> Read:
    def read_text(name: str, text: str, **arguments: str) -> LaunchFile:
        file = tmp_path / name
        file.write_text(text)
        return read_launch_file(file, arguments)

    return read_text


def without_place(node: LaunchedNode) -> dict[str, object]:
    return {key: vars(node)[key] for key in COMPARED}


def values(node: LaunchedNode) -> dict[str, object]:
    sources = [source for source in node.parameters if isinstance(source, dict)]
    return {name: value for source in sources for name, value in source.items()}


@pytest.mark.parametrize(("name", "text"), ALL)
def test_nodes_are_found_in_every_format(read: Read, name: str, text: str) -> None:
    talker, listener = read(name, text).nodes
    assert values(talker) == {"rate_hz": 2.5, "label": "7"}
    assert without_place(talker) == {
        "name": "talker",
        "namespace": "/left",
        "package": "demo",
        "executable": "talker",
        "command": (),
        "remappings": (("chatter", "/left/chatter"),),
        "arguments": ("--say", "hello you"),
        "ros_arguments": (),
        "env": {"MOOD": "calm"},
    }
    assert (listener.label, listener.namespace, listener.name) == ("listener", "/", None)


@pytest.mark.parametrize(("name", "text"), ALL)
def test_arguments_replace_defaults(read: Read, name: str, text: str) -> None:
    launch = read(name, text, prefix="right", rate_hz="6")
    assert [node.namespace for node in launch.nodes] == ["/right", "/"]
    assert launch.nodes[0].remappings == (("chatter", "/right/chatter"),)
    assert launch.arguments == {"rate_hz", "prefix"}


@pytest.mark.parametrize(("name", "text"), ALL)
def test_the_line_of_a_node_is_known(read: Read, name: str, text: str) -> None:
    line = text.splitlines()[read(name, text).nodes[0].line - 1]
    assert "node" in line.lower()


def test_included_files_take_arguments_and_know_their_directory(tmp_path: Path, read: Read) -> None:
    (tmp_path / "part").mkdir()
    (tmp_path / "part/inner.launch.py").write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument\n"
        "from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([\n"
        "        DeclareLaunchArgument('who'),\n"
        "        Node(package='demo', executable='e', name=LaunchConfiguration('who'),\n"
        "             arguments=[ThisLaunchFileDir()]),\n"
        "    ])\n"
    )
    launch = read(
        "outer.launch.xml",
        '<launch><group><push-ros-namespace namespace="robot"/>'
        '<include file="$(dirname)/part/inner.launch.py"><arg name="who" value="me"/></include>'
        "</group></launch>",
    )
    (node,) = launch.nodes
    assert (node.name, node.namespace) == ("me", "/robot")
    assert node.arguments == (str(tmp_path / "part"),)


def test_what_a_group_sets_ends_with_it(read: Read) -> None:
    launch = read(
        "demo.launch.xml",
        "<launch><group>"
        '<set_remap from="a" to="b"/><set_parameter name="use_sim_time" value="true"/>'
        '<set_env name="IN" value="1"/>'
        '<group><push-ros-namespace namespace="x"/><push-ros-namespace namespace="y"/>'
        '<node pkg="p" exec="inside"/></group>'
        '</group><node pkg="p" exec="outside"/></launch>',
    )
    inside, outside = launch.nodes
    assert inside.namespace == "/x/y"
    assert inside.remappings == (("a", "b"),)
    assert inside.parameters == ({"use_sim_time": True},)
    assert inside.env == {"IN": "1"}
    assert (outside.namespace, outside.remappings, outside.parameters, outside.env) == (
        ("/", (), (), {})
    )


def test_an_unscoped_group_leaves_what_it_sets(read: Read) -> None:
    launch = read(
        "demo.launch.xml",
        '<launch><group scoped="false"><push-ros-namespace namespace="x"/></group>'
        '<node pkg="p" exec="e"/></launch>',
    )
    assert launch.nodes[0].namespace == "/x"


def test_an_absolute_namespace_ignores_the_pushed_one(read: Read) -> None:
    launch = read(
        "demo.launch.xml",
        '<launch><push-ros-namespace namespace="x"/>'
        '<node pkg="p" exec="low" namespace="y"/><node pkg="p" exec="top" namespace="/z"/>'
        "</launch>",
    )
    assert [node.namespace for node in launch.nodes] == ["/x/y", "/z"]


def test_parameter_files_keep_their_order_and_may_hold_substitutions(
    tmp_path: Path, read: Read
) -> None:
    plain, expanded = tmp_path / "plain.yaml", tmp_path / "expanded.yaml"
    plain.write_text("/**: {ros__parameters: {a: 1}}\n")
    expanded.write_text("/**: {ros__parameters: {map: $(var map)/tiles, deep: {n: 3}}}\n")
    launch = read(
        "demo.launch.xml",
        '<launch><arg name="map" default="/maps"/><node pkg="p" exec="e">'
        f'<param from="{plain}"/><param from="{expanded}" allow_substs="true"/>'
        '<param name="list" value="1,2" value-sep=","/>'
        '<param name="group"><param name="inner" value="x"/></param></node></launch>',
    )
    assert launch.nodes[0].parameters == (
        plain,
        ExpandedFile(expanded, "/**: {ros__parameters: {map: /maps/tiles, deep: {n: 3}}}\n"),
        {"list": [1, 2]},
        {"group.inner": "x"},
    )


@pytest.mark.parametrize(
    ("written", "read_as"),
    [
        (r"a\nb", "anb"),
        (r"\$(var x)", "$(var x)"),
        (r"\\$(var x)", r"\$(var x)"),
        (r"\\ $(var x)", r"\ 1"),
        ("end\\", "end\\"),
        ("\\\n", "\\\n"),
    ],
)
def test_backslashes_are_those_of_launch(written: str, read_as: str) -> None:
    context = LaunchContext(arguments={"x": "1"})
    assert perform(context, parse(written)) == read_as


def test_a_substitution_stays_one_argument(read: Read) -> None:
    launch = read(
        "demo.launch.xml",
        '<launch><arg name="words" default="two words"/>'
        '<node pkg="p" exec="e" args="--x $(var words) --y=$(var words)"/></launch>',
    )
    assert launch.nodes[0].arguments == ("--x", "two words", "--y=two words")


def test_executables_are_commands(read: Read) -> None:
    launch = read("demo.launch.xml", '<launch><executable cmd="cat -u" name="copy"/></launch>')
    assert (launch.nodes[0].label, launch.nodes[0].command) == ("copy", ("cat", "-u"))


def test_opaque_functions_run_with_the_arguments(read: Read) -> None:
    launch = read(
        "demo.launch.py",
        "from launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument, OpaqueFunction\n"
        "from launch.substitutions import LaunchConfiguration\n"
        "from launch_ros.actions import Node\n"
        "def setup(context, *args):\n"
        "    count = int(LaunchConfiguration('count').perform(context))\n"
        "    return [Node(package='p', executable='e', name=f'n{i}') for i in range(count)]\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([DeclareLaunchArgument('count'),\n"
        "                              OpaqueFunction(function=setup)])\n",
        count="2",
    )
    assert [node.name for node in launch.nodes] == ["n0", "n1"]


def test_what_has_no_effect_here_is_noted(read: Read) -> None:
    launch = read(
        "demo.launch.xml",
        '<launch>\n<timer period="2">\n<shutdown reason="over"/>\n</timer>\n'
        '<log message="hello"/>\n</launch>',
    )
    places = [notice.rpartition("/")[2] for notice in launch.notices]
    assert places == [
        "demo.launch.xml:5: hello",
        "demo.launch.xml:3: a shutdown takes effect only when a process ends",
    ]


def test_an_installed_launch_package_is_left_as_it_was(
    read: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = ModuleType("launch")
    monkeypatch.setitem(sys.modules, "launch", real)
    read("demo.launch.py", PYTHON)
    assert sys.modules["launch"] is real
    assert "launch_ros" not in sys.modules


def test_arrays_are_of_one_type(read: Read) -> None:
    """ROS 2 launch converts mixed numbers in Python to floats, and refuses any other mixture."""
    node = "launch:\n  - node: {{exec: sh, param: [{{name: x, value: {0}}}]}}\n"
    assert values(read("demo.launch.yaml", node.format("[1, 2]")).nodes[0]) == {"x": [1, 2]}
    for mixed in ("[1, 2.5]", "[1, a]"):
        with pytest.raises(MapfileError, match=r"yaml:2: param: expected .*list"):
            read("demo.launch.yaml", node.format(mixed))
    python = PYTHON.replace("'rate_hz': rate_hz", "'x': [1, 2.5]").replace(
        '"rate_hz": rate_hz', '"x": [1, 2.5]'
    )
    assert values(read("demo.launch.py", python).nodes[0])["x"] == [1.0, 2.5]


def test_files_that_include_others_twice_over_are_bounded(tmp_path: Path, read: Read) -> None:
    """Each file includes the next twice: 2**40 files in all, and none includes itself."""
    for number in range(1, 40):
        include = f'<include file="$(dirname)/{number + 1}.xml"/>'
        (tmp_path / f"{number}.xml").write_text(f"<launch>{include * 2}</launch>")
    (tmp_path / "40.xml").write_text("<launch/>")
    with pytest.raises(MapfileError, match="at most 1000 launch files, each include counted"):
        read("outer.launch.xml", '<launch><include file="$(dirname)/1.xml"/></launch>')


def test_an_expression_may_print_and_import(read: Read) -> None:
    launch = read(
        "demo.launch.xml",
        """<launch><node pkg="p" exec="$(eval 'print(1) or fractions.Fraction(1, 2)' 'fractions')"/>
        </launch>""",
    )
    assert launch.nodes[0].executable == "1/2"


def test_a_command_reads_nothing_and_prints_text(tmp_path: Path, read: Read) -> None:
    launch = read("demo.launch.xml", """<launch><log message="said: $(command 'cat')"/></launch>""")
    assert launch.notices[0].endswith(": said: ")
    file = tmp_path / "bytes"
    file.write_bytes(b"\xff")
    launch = read(
        "demo.launch.xml", f"""<launch><log message="$(command 'cat {file}')"/></launch>"""
    )
    assert "expected a command that runs, found" in launch.notices[0]
    assert "can't decode" in launch.notices[0]


def test_a_command_that_does_not_end_is_stopped(
    read: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "TIMEOUT_S", 0.1)
    text = """<launch><node exec="$(command 'sleep 1000')" name="n"/></launch>"""
    (node,) = read("demo.launch.xml", text).nodes
    assert node.problem is not None
    assert node.problem.found == "'sleep 1000': no end after 0.1 s"
