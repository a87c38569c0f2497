# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles whose nodes `ros2 launch` starts, and how that process finds the placements."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import check, load_mapfile
from rmw_manycore_py.mapfile.placing.resolve import resolve_places

pytestmark = pytest.mark.unit


def places(directory: Path, text: str):
    file = directory / "map.yaml"
    file.write_text(text)
    return resolve_places(load_mapfile(file, starts_nodes=False))


def test_nodes_need_no_way_to_start(tmp_path: Path) -> None:
    text = (
        "platform: {profile: coolidge, name: demo}\n"
        "topics: {/chatter: {type: std_msgs/msg/String, topic_dsm_size: 10000}}\n"
        "nodes:\n"
        "  one: {cluster: 1, core: 4, wait: spin, env: {A: b}}\n"
        "  /left/two: {cluster: 2, workers: 2, topic_to: {words: std_msgs/msg/String}}\n"
    )
    placement = places(tmp_path, text)
    one, two = placement.nodes
    assert (one.cluster, one.core, one.argv) == (1, 4, [])
    assert one.env["A"] == "b"
    assert one.env["MANYCORE_WAIT"] == "spin"
    assert (one.env["MANYCORE_PLATFORM"], one.env["MANYCORE_CORE"]) == ("demo", "4")
    assert (two.cluster, two.core, len(two.workers)) == (2, 1, 2)
    assert placement.bridge is not None
    assert [route.inside for route in placement.bridge.routes] == ["/left/words"]
    assert [(topic.name, topic.topic_dsm_size) for topic in placement.topics] == [
        ("/chatter", 10000)
    ]
    with pytest.raises(MapfileError, match="no way to start the node"):
        check(tmp_path / "map.yaml")


@pytest.mark.parametrize(
    "key",
    [
        "module: a",
        "command: a",
        "parameters: {a: 1}",
        "remappings: {a: b}",
        "namespace: a",
        "arguments: a",
    ],
)
def test_keys_that_the_launch_file_decides_are_refused(tmp_path: Path, key: str) -> None:
    with pytest.raises(MapfileError) as refusal:
        places(tmp_path, f"nodes:\n  one:\n    cluster: 1\n    {key}\n")
    (problem,) = refusal.value.problems
    assert (problem.line, problem.key) == (4, f"nodes.one.{key.partition(':')[0]}")
    assert "ros2 launch starts it" in problem.expected


def test_a_type_that_an_installed_package_lacks_is_a_notice(tmp_path: Path) -> None:
    (tmp_path / "node.py").write_text("from std_msgs.msg import Strong\n")
    (tmp_path / "map.yaml").write_text("nodes:\n  a: {cluster: 1, script: node.py}\n")
    notices = check(tmp_path / "map.yaml").notices
    assert "'a' imports std_msgs/msg/Strong (node.py:1), which its package does not have" in notices
