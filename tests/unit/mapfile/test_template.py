# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import check, init

pytestmark = pytest.mark.unit

NODE = """\
from rclpy.node import Node
from std_msgs.msg import String
class A(Node):
    def __init__(self):
        super().__init__("{name}")
        self.create_{kind}(String, {topic}, 10)
"""


def write_node(file: Path, name: str, kind: str, topic: str = '"chatter"') -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(NODE.format(name=name, kind=kind, topic=topic))


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


def test_files_of_packages_become_modules(tmp_path: Path) -> None:
    write_node(tmp_path / "app/talker.py", "talker", "publisher")
    (tmp_path / "app/__init__.py").touch()
    assert "    module: app.talker\n" in init([tmp_path / "app"], tmp_path)


def test_nodes_of_a_launch_file_take_topics_from_their_sources(tmp_path: Path) -> None:
    write_node(tmp_path / "talker.py", "talker", "publisher")
    launch = tmp_path / "demo.launch.xml"
    launch.write_text('<launch><node pkg="p" exec="talker"/><node pkg="p" exec="other"/></launch>')
    lines = init([launch, tmp_path], tmp_path).splitlines()
    assert "launch_path: demo.launch.xml" in lines
    assert not [line for line in lines if "script" in line]
    assert lines[lines.index("  talker:") + 3] == "      chatter: std_msgs/msg/String"


def test_what_cannot_be_read_is_said(tmp_path: Path) -> None:
    write_node(tmp_path / "talker.py", "talker", "publisher", topic="name")
    assert "    # talker.py:6: topic or type is computed; add it here\n" in init([tmp_path])


def test_sources_without_nodes_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="no nodes found in"):
        init([tmp_path])
    with pytest.raises(ManycoreError, match="no such file or directory"):
        init([tmp_path / "absent.py"])
