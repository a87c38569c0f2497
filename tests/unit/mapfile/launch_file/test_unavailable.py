# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A missing command, file, package or module only affects the node that needs it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from rmw_manycore_distribution import NAME
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.launch_file import LaunchFile, read_launch_file

pytestmark = pytest.mark.unit

HEAD = """\
import os
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from ament_index_python.packages import get_package_share_directory

def node(name, **described):
    return Node(executable='sh', name=name, **described)
"""
PACKAGE = (
    "expected the package 'absent', found that it is not installed: "
    "pip install ./absent, or source its workspace"
)


def read(directory: Path, actions: str, before: str = "", top: str = "") -> LaunchFile:
    file = directory / "demo.launch.py"
    generate = f"def generate_launch_description():\n    {before}\n"
    file.write_text(f"{HEAD}\n{top}\n{generate}    return LaunchDescription([{actions}])\n")
    return read_launch_file(file)


def reasons(launch: LaunchFile) -> dict[str, str | None]:
    """Return why each node cannot run, None if it can."""
    return {
        node.label: None
        if node.problem is None
        else f"expected {node.problem.expected}, found {node.problem.found}"
        for node in launch.nodes
    }


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (
            "Command(['no_such_xacro ', 'robot.urdf'])",
            "expected a command that runs, found 'no_such_xacro robot.urdf': No such file or "
            "directory",
        ),
        (
            "Command('sh -c \"echo no >&2; exit 3\"')",
            "expected a command that succeeds, found 'sh -c \"echo no >&2; exit 3\"': no",
        ),
        (
            "Command('sh -c \"echo no >&2\"')",
            "expected a command that succeeds, found 'sh -c \"echo no >&2\"': no",
        ),
        ("Command(['xacro ', FindPackageShare('absent'), '/robot.urdf'])", PACKAGE),
        (
            "FindExecutable(name='no_such_xacro')",
            "expected an executable on the PATH, found 'no_such_xacro'",
        ),
        ("[PathJoinSubstitution([FindPackageShare('absent'), 'urdf']), '/a']", PACKAGE),
        ("f\"file://{get_package_share_directory('absent')}/a.stl\"", PACKAGE),
        (
            "open('/no/such/file').read() + 'more'",
            "expected a readable file, found '/no/such/file': No such file or directory",
        ),
        ("open(os.path.join(get_package_share_directory('absent'), 'a.urdf')).read()", PACKAGE),
        (
            "NotSubstitution(Command('no_such_command'))",
            "expected a command that runs, found 'no_such_command': No such file or directory",
        ),
        ("IfElseSubstitution(FindPackageShare('absent'), 'a', 'b')", PACKAGE),
    ],
)
def test_a_missing_value_only_affects_its_node(tmp_path: Path, value: str, reason: str) -> None:
    value = f"ParameterValue({value}, value_type=str)"
    launch = read(tmp_path, f"node('a', parameters=[{{'x': {value}}}]), node('b')")
    assert reasons(launch) == {"a": reason, "b": None}


@pytest.mark.parametrize(
    "described",
    [
        "arguments=['-d', PathJoinSubstitution([FindPackageShare('absent'), 'a.rviz'])]",
        "arguments=['-d', os.path.join(get_package_share_directory('absent'), 'a.rviz')]",
        "parameters=[get_package_share_directory('absent') + '/a.yaml']",
        "parameters=[{'x': [1, [FindPackageShare('absent')]]}]",
        "remappings=[('a', get_package_share_directory('absent'))]",
        "additional_env={'A': FindPackageShare('absent')}",
        "cwd=get_package_share_directory('absent')",
        "namespace=FindPackageShare('absent')",
        "parameters=[LaunchConfiguration('config')]",
        "parameters=[{'x': [LaunchConfiguration('config'), '/more']}]",
    ],
)
def test_a_missing_package_is_named_wherever_its_directory_is_used(
    tmp_path: Path, described: str
) -> None:
    argument = "DeclareLaunchArgument('config', default_value=[FindPackageShare('absent'), '/c'])"
    launch = read(tmp_path, f"{argument}, node('a', {described}), node('b')")
    assert reasons(launch) == {"a": PACKAGE, "b": None}
    assert not [notice for notice in launch.notices if "unavailable/" in notice]


def test_a_missing_python_module_only_affects_what_uses_it(tmp_path: Path) -> None:
    launch = read(
        tmp_path,
        "node('a', parameters=[{'x': robot}]), node('b', parameters=[config.to_dict()]),"
        "node('c', remappings=config.remappings), node('d'), config.action(),"
        "node('e', parameters=[{'x': f'{robot} and more'}])",
        before="robot = no_xacro.process_file('a.urdf').toxml(); "
        "config = Builder('r', package_name='p').file(path='x').made['all']",
        top="import no_xacro\nfrom no_moveit.configs import Builder",
    )
    xacro = "expected the Python module 'no_xacro', found that it is not installed"
    moveit = "expected the Python module 'no_moveit', found that it is not installed"
    assert reasons(launch) == {"a": xacro, "b": moveit, "c": moveit, "d": None, "e": xacro}
    assert any(notice.endswith(f"cannot run here: {moveit}") for notice in launch.notices)


def test_an_opaque_function_only_loses_what_needs_something_missing(tmp_path: Path) -> None:
    top = (
        "def starts(context):\n"
        "    words = FindPackageShare('absent').perform(context)\n"
        "    return [node('a', arguments=[words]), node('b')]\n"
        "def parses(context):\n"
        "    import yaml\n"
        "    with open(get_package_share_directory('absent') + '/a.yaml') as file:\n"
        "        return [node(name) for name in yaml.safe_load(file)]\n"
        "def reads(context):\n"
        "    from pathlib import Path\n"
        "    return [node(Path(get_package_share_directory('absent'), 'name').read_text())]\n"
    )
    functions = ", ".join(f"OpaqueFunction(function={n})" for n in ("starts", "parses", "reads"))
    launch = read(tmp_path, f"{functions}, node('c')", top=top)
    assert reasons(launch) == {"a": PACKAGE, "b": None, "c": None}
    places = [n.partition("demo.launch.py:")[2] for n in launch.notices if n.endswith(PACKAGE)]
    lines = (tmp_path / "demo.launch.py").read_text().splitlines()
    named = [lines[int(place.partition(":")[0]) - 1].strip() for place in places]
    assert named == [
        "return Node(executable='sh', name=name, **described)",
        "return [node(name) for name in yaml.safe_load(file)]",
        "return [node(Path(get_package_share_directory('absent'), 'name').read_text())]",
    ]


def test_code_that_needs_what_is_missing_names_it(tmp_path: Path) -> None:
    missing = "get_package_share_directory('absent')"
    with pytest.raises(MapfileError, match=rf"demo.launch.py:15: {PACKAGE}"):
        read(tmp_path, "node('a')", before=f"os.listdir({missing})")
    with pytest.raises(MapfileError, match=r"expected the Python module 'no_such', found that it"):
        read(
            tmp_path,
            "node('a')",
            before="[print(one) for one in no_such.all]",
            top="import no_such",
        )


def test_a_description_made_by_a_missing_module_names_it(tmp_path: Path) -> None:
    (tmp_path / "inner.launch.py").write_text(
        "from no_moveit import generate_demo\n"
        "def generate_launch_description():\n    return generate_demo()\n"
    )
    missing = "expected the Python module 'no_moveit', found that it is not installed"
    with pytest.raises(MapfileError, match=f"inner.launch.py: {missing}"):
        read_launch_file(tmp_path / "inner.launch.py")
    include = "IncludeLaunchDescription([ThisLaunchFileDir(), '/inner.launch.py'])"
    launch = read(tmp_path, f"{include}, node('b')")
    assert reasons(launch) == {"b": None}
    assert launch.notices[0].endswith(f"cannot run here: {missing}")


def test_an_include_names_its_missing_package(tmp_path: Path) -> None:
    include = "IncludeLaunchDescription([FindPackageShare('absent'), '/launch/other.launch.py'])"
    (tmp_path / "inner.launch.py").write_text(
        "import os\n"
        "from ament_index_python.packages import get_package_share_directory\n"
        "def generate_launch_description():\n"
        "    return os.listdir(get_package_share_directory('absent'))\n"
    )
    inner = "IncludeLaunchDescription([ThisLaunchFileDir(), '/inner.launch.py'])"
    launch = read(tmp_path, f"{include}, {inner}, node('b')")
    assert reasons(launch) == {"b": None}
    assert any("the package 'absent' is not installed" in notice for notice in launch.notices)
    places = [n.partition(f"{tmp_path}/")[2] for n in launch.notices if n.endswith(PACKAGE)]
    assert [place.partition(": ")[0] for place in places] == [
        "demo.launch.py:16",
        "inner.launch.py:4",
    ]


def test_a_try_finds_out_what_is_missing(tmp_path: Path) -> None:
    lines = (
        "try:",
        "    import no_xacro",
        "except ImportError:",
        "    no_xacro = None",
        "from ament_index_python.packages import PackageNotFoundError",
        "try:",
        "    share = get_package_share_directory('absent')",
        "except PackageNotFoundError:",
        "    share = None",
        "try:",
        "    text = open('/no/such/file').read()",
        "except FileNotFoundError:",
        "    text = None",
    )
    launch = read(tmp_path, "node(str((no_xacro, share, text)))", top="\n".join(lines))
    assert [node.name for node in launch.nodes] == ["(None, None, None)"]


def test_modules_of_others_are_not_made_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "own_helper.py").write_text("import no_such_module\n")
    with pytest.raises(MapfileError, match="No module named 'no_such_module'"):
        read(tmp_path, "node('a')", top="import own_helper")


def test_a_file_that_is_written_is_opened(tmp_path: Path) -> None:
    written = tmp_path / "made.yaml"
    read(tmp_path, "node('a')", before=f"open({str(written)!r}, 'w').write('a: 1')")
    assert written.read_text() == "a: 1"
    with pytest.raises(MapfileError, match=r"FileNotFoundError: .*no/such"):
        read(tmp_path, "node('a')", before="open('/no/such/directory/file', 'w')")


@pytest.mark.parametrize("name", ["ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION"])
def test_the_environment_is_that_of_a_sourced_ros(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.delenv(name, raising=False)
    launch = read(
        tmp_path, f"node(EnvironmentVariable('{name}')), node(os.environ['{name}'] + '_')"
    )
    expected = {"ROS_DISTRO": NAME, "ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3"}[name]
    assert [node.name for node in launch.nodes] == [expected, f"{expected}_"]
    assert name not in os.environ


def test_code_reads_no_input(tmp_path: Path) -> None:
    read_fd, write_fd = os.pipe()
    terminal = os.dup(0)
    os.dup2(read_fd, 0)  # open, and nothing ever arrives
    try:
        with pytest.raises(MapfileError, match=r"demo.launch.py:15: .*EOFError"):
            read(tmp_path, "node('a')", before="input('which robot? ')")
        (node,) = read(tmp_path, "node('a' + __import__('sys').stdin.read())").nodes
    finally:
        os.dup2(terminal, 0)
        for one in (terminal, read_fd, write_fd):
            os.close(one)
    assert node.name == "a"
