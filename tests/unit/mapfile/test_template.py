# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import check, init
from support.samples.node_source import node_source

pytestmark = pytest.mark.unit


def write_node(file: Path, name: str, kind: str, topic: str = '"chatter"') -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(node_source(name, kind, topic=topic) + "main()\n")


def test_only_the_clusters_are_left_to_fill_in(tmp_path: Path) -> None:
    write_node(tmp_path / "talker.py", "talker", "publisher")
    write_node(tmp_path / "listener.py", "listener", "subscription")
    text = init([tmp_path], tmp_path)
    assert text.splitlines()[1:] == [
        "platform: host",
        "nodes:",
        "  listener:",
        "    cluster: 1  # choose",
        "    script: listener.py",
        "    subscribe:",
        "      chatter: std_msgs/msg/String",
        "  talker:",
        "    cluster: 1  # choose",
        "    script: talker.py",
        "    publish:",
        "      chatter: std_msgs/msg/String",
    ]


def test_a_template_is_a_valid_mapfile(tmp_path: Path) -> None:
    write_node(tmp_path / "talker.py", "talker", "publisher")
    write_node(tmp_path / "more/talker.py", "talker", "publisher")
    mapfile = tmp_path / "mapfile.yaml"
    mapfile.write_text(init([tmp_path], tmp_path))
    assert [node.name for node in check(mapfile).nodes] == ["talker", "talker2"]


def test_what_tools_made_is_no_source(tmp_path: Path) -> None:
    write_node(tmp_path / "robot/robot/talker.py", "talker", "publisher")
    (tmp_path / "robot/setup.py").touch()
    (tmp_path / "install/COLCON_IGNORE").parent.mkdir()
    (tmp_path / "install/COLCON_IGNORE").touch()
    (tmp_path / "env/pyvenv.cfg").parent.mkdir()
    (tmp_path / "env/pyvenv.cfg").touch()
    for copies in ("robot/build/lib", "install/robot/lib", "env/lib", "robot/robot.egg-info"):
        write_node(tmp_path / copies / "robot/talker.py", "talker", "publisher")
    write_node(tmp_path / "build/listener.py", "listener", "subscription")  # no project's build
    text = init([tmp_path], tmp_path)
    scripts = [line.split()[1] for line in text.splitlines() if "script:" in line]
    assert scripts == ["build/listener.py", "robot/robot/talker.py"]


def test_more_nodes_than_cores_share_them(tmp_path: Path) -> None:
    for number in range(71):
        write_node(tmp_path / f"node{number}.py", f"node{number}", "publisher", f'"t{number}"')
    mapfile = tmp_path / "mapfile.yaml"
    mapfile.write_text(init([tmp_path], tmp_path, "coolidge"))
    nodes_on = Counter(node.place for node in check(mapfile).nodes)
    assert (sum(nodes_on.values()), max(nodes_on.values())) == (71, 2)


def test_files_of_packages_become_modules(tmp_path: Path) -> None:
    write_node(tmp_path / "app/talker.py", "talker", "publisher")
    (tmp_path / "app/__init__.py").touch()
    assert "    module: app.talker\n" in init([tmp_path / "app"], tmp_path)


def install(prefix: Path, package: str, *executables: str, content: str = "#!/bin/sh\n") -> None:
    """Write an ament package with programs into a prefix."""
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True, exist_ok=True)
    (index / package).touch()
    for name in executables:
        program = prefix / "lib" / package / name
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(content)
        program.chmod(0o755)


@pytest.fixture
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    directory = tmp_path / "prefix"
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(directory))
    return directory


def test_nodes_of_a_launch_file_take_topics_from_their_sources(
    tmp_path: Path, prefix: Path
) -> None:
    install(prefix, "p", "talker", "other")
    write_node(tmp_path / "talker.py", "talker", "publisher")
    launch = tmp_path / "demo.launch.xml"
    launch.write_text('<launch><node pkg="p" exec="talker"/><node pkg="p" exec="other"/></launch>')
    lines = init([launch, tmp_path], tmp_path).splitlines()
    assert "launch_path: demo.launch.xml" in lines
    assert not [line for line in lines if "script" in line]
    assert lines[lines.index("  talker:") + 3] == "      chatter: std_msgs/msg/String"


def test_a_module_that_starts_nothing_is_started_by_its_entry_point(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "robo"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "detect.py").write_text(node_source("detector", "publisher"))
    assert "  # starts nothing: install its package" in init([package], tmp_path)
    info = tmp_path / "robo-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: robo\nVersion: 0.1\n")
    (info / "entry_points.txt").write_text("[console_scripts]\ndetector = robo.detect:main\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    text = init([package], tmp_path)
    assert "    package: robo\n    executable: detector\n" in text
    assert "starts nothing" not in text
    assert "module:" not in text


def test_a_computed_topic_is_reported(tmp_path: Path) -> None:
    write_node(tmp_path / "talker.py", "talker", "publisher", topic="name")
    assert "    # talker.py:6: topic or type is computed; add it here\n" in init([tmp_path])


def test_sources_without_nodes_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="no nodes found in"):
        init([tmp_path])
    with pytest.raises(ManycoreError, match="no such file or directory"):
        init([tmp_path / "absent.py"])


def test_nodes_that_cannot_run_here_are_comments(tmp_path: Path, prefix: Path) -> None:
    install(prefix, "p", "talker")
    launch = tmp_path / "robot_launch.py"
    launch.write_text(
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([\n"
        "        Node(package='p', executable='talker'),\n"
        "        Node(package='absent', executable='listener'),\n"
        "    ])\n"
    )
    lines = init([launch], tmp_path).splitlines()
    assert "  talker:" in lines
    (comment,) = (line for line in lines if "listener" in line)
    assert comment.startswith("  # listener cannot run here: ")
    assert comment.endswith(
        "the package 'absent', found that it is not installed: "
        "pip install ./absent, or source its workspace"
    )
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("\n".join(lines))
    assert [node.name for node in check(mapfile).nodes] == ["talker"]


def test_arguments_of_a_launch_file_are_kept(tmp_path: Path, prefix: Path) -> None:
    install(prefix, "p", "talker")
    launch = tmp_path / "demo.launch.xml"
    launch.write_text(
        '<launch><arg name="who"/><node pkg="p" exec="talker" name="$(var who)"/></launch>'
    )
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(init([launch], tmp_path, arguments={"who": "left"}))
    assert [node.full_name for node in check(mapfile).nodes] == ["/left"]
    with pytest.raises(ManycoreError, match="NAME:=VALUE is for a launch file"):
        init([tmp_path], tmp_path, arguments={"who": "left"})


def test_arguments_that_a_launch_file_does_not_declare_reach_it_with_a_notice(
    tmp_path: Path, prefix: Path
) -> None:
    install(prefix, "p", "talker")
    launch = tmp_path / "demo.launch.xml"
    launch.write_text(
        '<launch><arg name="rate" default="1"/>'
        '<node pkg="p" exec="talker" name="$(var who)"/></launch>'
    )
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(init([launch], tmp_path, arguments={"who": "left", "ratee": "2"}))
    placement = check(mapfile)
    assert [node.full_name for node in placement.nodes] == ["/left"]
    does_not = "demo.launch.xml does not declare it (it declares rate)"
    assert [n for n in placement.notices if "launch_arguments" in n] == [
        f"{mapfile}:5: launch_arguments.who: {does_not}",
        f"{mapfile}:6: launch_arguments.ratee: {does_not}; did you mean 'rate'?",
    ]


def test_components_run_alone_where_only_they_are_installed(tmp_path: Path, prefix: Path) -> None:
    install(prefix, "p", "camera", content="#!/bin/sh\n# NodeFactoryTemplate<p::Camera>\n")
    install(prefix, "p", "other", content="#!/bin/sh\n# NodeFactoryTemplate<p::Other>\n")
    launch = tmp_path / "demo.launch.xml"
    launch.write_text(
        '<launch><node_container pkg="absent" exec="component_container" name="c" namespace="">'
        '<composable_node pkg="p" plugin="p::Camera" name="eye" namespace="left">'
        '<param name="rate" value="5"/><remap from="a" to="b"/></composable_node>'
        '<composable_node pkg="p" plugin="p::Lens" name="lens"/>'
        "</node_container></launch>"
    )
    text = init([launch], tmp_path)
    assert "  # c cannot run here: " in text
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(text)
    placement = check(mapfile)
    assert f"{launch}:1: 'eye' is a process of its own, in no container" in placement.notices
    (node,) = placement.nodes
    assert (node.name, node.full_name) == ("eye", "/left/eye")
    assert node.argv[0] == str(prefix / "lib/p/camera")
    assert node.parameters == {"rate": 5}
    assert "a:=b" in node.argv
