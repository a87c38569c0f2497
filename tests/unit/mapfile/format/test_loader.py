# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.mapfile import Mapfile, load_mapfile
from rmw_manycore_py.ros.ament import canonical_type

pytestmark = pytest.mark.unit

FIGURE_8 = """\
nodes:
  talker:
    cluster: 1
    core: 1
    topic_in:
      chatter: /std_msgs/msg/string
    topic_to:
    none:
    param_file:
    none:
  listener:
    cluster: 2
    core: 1
    topic_in:
      none:
    topic_to:
      chatter: std_msgs::String
    param_path:
      none:
launch_path: nodes.launch.xml
"""

FIGURE_7 = """\
- name: talker
  cluster: 1
  publish: [/chatter]
  publish_type: ["std_msgs::String"]
  subscribe: []
  subscribe_type: []
  module: this
- name: listener
  cluster: 16
  publish: []
  publish_type: []
  subscribe: [/chatter]
  subscribe_type: ["std_msgs::String"]
  module: this
"""


def load(directory: Path, text: str) -> Mapfile:
    file = directory / "mapfile.yaml"
    file.write_text(text)
    (directory / "nodes.launch.xml").write_text("<launch/>")
    return load_mapfile(file)


def test_figure_8_of_the_paper_is_read_as_it_is_printed(tmp_path: Path) -> None:
    mapfile = load(tmp_path, FIGURE_8)
    nodes = mapfile.sections.nodes
    assert nodes["talker"].topic_in == {"chatter": "std_msgs/msg/String"}
    assert nodes["talker"].topic_to == {}
    assert nodes["listener"].topic_in == {}
    assert nodes["listener"].topic_to == {"chatter": "std_msgs/msg/String"}
    assert nodes["listener"].param_file == ()


def test_corrected_spellings_are_noted_with_their_line(tmp_path: Path) -> None:
    notices = load(tmp_path, FIGURE_8).notices
    assert [notice.removeprefix(f"{tmp_path}/") for notice in notices] == [
        "mapfile.yaml:6: nodes.talker.topic_in.chatter: "
        "/std_msgs/msg/string is read as std_msgs/msg/String",
        "mapfile.yaml:17: nodes.listener.topic_to.chatter: "
        "std_msgs::String is read as std_msgs/msg/String",
    ]


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("std_msgs/String", "std_msgs/msg/String"),
        ("/sensor_msgs/msg/point_cloud2", "sensor_msgs/msg/PointCloud2"),
        ("sensor_msgs::pointcloud2", "sensor_msgs/msg/PointCloud2"),
        ("/std_srvs/srv/set_bool", "std_srvs/srv/SetBool"),
        ("not_installed/msg/thing", "not_installed/msg/Thing"),
    ],
)
def test_types_are_known_in_other_spellings(written: str, read: str) -> None:
    assert canonical_type(written) == read


def test_param_path_is_param_file(tmp_path: Path) -> None:
    (tmp_path / "talker.yaml").write_text("talker: {ros__parameters: {rate_hz: 1.0}}")
    text = "nodes:\n  talker: {cluster: 1, module: this, param_path: talker.yaml}\n"
    mapfile = load(tmp_path, text)
    assert mapfile.sections.nodes["talker"].param_file == ("talker.yaml",)
    assert mapfile.notices[0].endswith("param_path is read as param_file")


def test_the_map_list_of_ros_lite_is_read(tmp_path: Path) -> None:
    mapfile = load(tmp_path, FIGURE_7)
    assert mapfile.topology.profile == "bostan"
    assert mapfile.sections.nodes["talker"].publish == {"/chatter": "std_msgs/msg/String"}
    assert mapfile.sections.nodes["listener"].cluster == 16


@pytest.mark.parametrize(
    ("written", "size_bytes"),
    [("10000", 10000), ("64KiB", 65536), ("4 MiB", 4 << 20), ("2MB", 2_000_000), ("8B", 8)],
)
def test_sizes_have_units(tmp_path: Path, written: str, size_bytes: int) -> None:
    topics = f"topics:\n  /a: {{topic_dsm_size: {written}}}\n"
    mapfile = load(tmp_path, f"{topics}nodes:\n  n: {{cluster: 1, module: this}}\n")
    assert mapfile.sections.topics["/a"].topic_dsm_size == size_bytes


def test_anchors_and_merge_keys_are_yaml_as_usual(tmp_path: Path) -> None:
    mapfile = load(
        tmp_path,
        "nodes:\n"
        "  a: &common {cluster: 1, module: this, wait: spin}\n"
        "  b: {<<: *common, cluster: 2}\n",
    )
    assert mapfile.sections.nodes["b"].cluster == 2
    assert mapfile.sections.nodes["b"].wait == "spin"


def test_the_explicit_options_lift_the_checks(tmp_path: Path) -> None:
    mapfile = load(
        tmp_path,
        "platform: coolidge\nallow_shared_cores: true\nallow_reserved_cores: true\n"
        "nodes:\n"
        "  a: {cluster: 1, core: 0, module: this}\n"
        "  b: {cluster: 1, core: 0, module: this}\n",
    )
    assert [node.core for node in mapfile.sections.nodes.values()] == [0, 0]


def test_nested_parameters_get_dotted_names(tmp_path: Path) -> None:
    mapfile = load(
        tmp_path,
        "nodes:\n  a: {cluster: 1, module: this, parameters: {pid: {p: 1.0, i: 2}, names: [x]}}\n",
    )
    assert mapfile.sections.nodes["a"].parameters == {"pid.p": 1.0, "pid.i": 2, "names": ["x"]}


def test_a_platform_takes_given_sizes(tmp_path: Path) -> None:
    mapfile = load(
        tmp_path,
        "platform: {profile: coolidge, clusters: 2, cores_per_cluster: 4, smem_size: 1MiB}\n"
        "nodes:\n  a: {cluster: 2, core: 3, module: this}\n",
    )
    assert [(c.id, c.cores, c.smem_size) for c in mapfile.topology.clusters] == [
        (1, 4, 1 << 20),
        (2, 4, 1 << 20),
    ]
