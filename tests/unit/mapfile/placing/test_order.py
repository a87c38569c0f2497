# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Notices and problems of a whole mapfile, in the order in which they are reported."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.format.loader import load_mapfile
from rmw_manycore_py.mapfile.placing.used_types import used_types
from rmw_manycore_py.mapfile.programs.source import Sources
from support.samples.node_source import node_source

pytestmark = pytest.mark.unit

LAUNCH = """\
<launch>
  <node exec="sh" name="first" launch-prefix="taskset -c 0"/>
  <node exec="sh" name="left_out"/>
</launch>
"""


def _write(directory: Path, mapfile: str, types: str = "String") -> Path:
    (directory / "one.py").write_text(node_source("one", types=types) + "main()\n")
    (directory / "pair.launch.xml").write_text(LAUNCH)
    file = directory / "mapfile.yaml"
    file.write_text(mapfile)
    return file


def test_notices_come_by_kind_then_by_node(tmp_path: Path) -> None:
    nodes = "".join(
        f"  n{number}: {{cluster: {number % 2 + 1}, script: one.py}}\n" for number in range(4)
    )
    text = (
        "platform: {profile: coolidge, name: chip}\nlaunch_path: pair.launch.xml\nnodes:\n"
        "  far: {cluster: 5, script: one.py, env: {ROS_DOMAIN_ID: 7},"
        " topic_to: {chattr: std_msgs/msg/String}}\n"
        "  first: {cluster: 3}\n" + nodes
    )
    notices = check(_write(tmp_path, text, "String, Gone")).notices
    starts = [notice.removeprefix(f"{tmp_path}/")[:48] for notice in notices]
    of_cpus = [start for start in starts if "cores in use on" in start]  # only on a small host
    assert [start for start in starts if start not in of_cpus] == [
        "pair.launch.xml:3: 'left_out' is not in the mapf",
        "'far' imports std_msgs/msg/Gone (one.py:2), which"[:48],
        *(f"'n{number}' imports std_msgs/msg/Gone (one.py:2), which"[:48] for number in range(4)),
        "mapfile.yaml:4: nodes.far.topic_to: no source pu",
        "pair.launch.xml:2: the mapfile overrules the pre",
        "'far' has ROS_DOMAIN_ID=7: it meets the nodes of",
    ]


def test_problems_come_by_line_types_before_imports(tmp_path: Path) -> None:
    text = (
        "platform: coolidge\n"
        "topics:\n  /big: {type: std_msgs/msg/Byte, topic_dsm_size: 900MiB}\n"
        "nodes:\n"
        "  a: {cluster: 1, script: one.py, topic_to: {chatter: std_msgs/msg/Int32}}\n"
        "  b: {cluster: 2, script: one.py, publish: {/big: std_msgs/msg/Nope}}\n"
    )
    file = _write(tmp_path, text)
    source = tmp_path / "one.py"
    source.write_text("from nowhere_msgs.msg import Thing\n" + source.read_text())
    with pytest.raises(MapfileError) as refused:
        check(file)
    assert [(problem.key, problem.found) for problem in refused.value.problems] == [
        ("topics./big.topic_dsm_size", "943718400"),
        ("nodes.a.topic_to.chatter", "std_msgs/msg/Int32"),
        ("nodes.a", "the package 'nowhere_msgs' not installed"),
        ("nodes.b.publish./big", "std_msgs/msg/Nope"),
        ("nodes.b", "std_msgs/msg/Nope"),
        ("nodes.b", "the package 'nowhere_msgs' not installed"),
    ]


def test_used_types_are_those_of_the_mapfile_and_of_imports(tmp_path: Path) -> None:
    text = "nodes:\n  a: {cluster: 1, script: one.py, subscribe: {/n: std_msgs/msg/Int8}}\n"
    mapfile = load_mapfile(_write(tmp_path, text, "String, Bool"))
    assert used_types(mapfile) == {f"std_msgs/msg/{name}" for name in ("Int8", "String", "Bool")}


def test_sources_parse_a_file_once(tmp_path: Path) -> None:
    _write(tmp_path, "")
    bad = tmp_path / "bad.py"
    bad.write_text("def (:\n")
    sources = Sources()
    read = sources.read(tmp_path / "one.py")
    assert read is not None
    assert sources.read(bad) is None
    bad.write_text("")
    (tmp_path / "one.py").write_text("")
    assert sources.read(tmp_path / "one.py") is read
    assert sources.read(bad) is None
