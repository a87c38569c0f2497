# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Our matcher instead of Autoware's: a prefix with its package name, launch and parameter files.

The installed Autoware is a stand-in: a package with files of the same structure.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.ndt.maps.map_file import write_points
from support import IS_MANYCORE
from support.processes.commands import manycore_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is part of rmw_manycore"),
]

CLOUD = "sensor_msgs/msg/PointCloud2"
PACKAGE = "autoware_ndt_scan_matcher"
LAUNCH_FILE = f"""\
<launch>
  <arg name="param_file" default="$(find-pkg-share {PACKAGE})/config/ndt_scan_matcher.param.yaml"/>
  <arg name="input_pointcloud" default="points_raw"/>
  <arg name="node_name" default="ndt_scan_matcher"/>
  <node pkg="{PACKAGE}" exec="{PACKAGE}_node" name="$(var node_name)" output="both">
    <remap from="points_raw" to="$(var input_pointcloud)"/>
    <param from="$(var param_file)"/>
  </node>
</launch>
"""
PARAMETERS = """\
/**:
  ros__parameters:
    ndt: {resolution: 3.0, num_threads: 2}
"""


LOADER = "autoware_map_loader"
LOADER_LAUNCH_FILE = f"""\
<launch>
  <arg name="pointcloud_map_path"/>
  <arg name="param_file" default="$(find-pkg-share {LOADER})/config/loader.param.yaml"/>
  <node pkg="{LOADER}" exec="autoware_pointcloud_map_loader" name="pointcloud_map_loader">
    <remap from="output/pointcloud_map" to="/map/pointcloud_map"/>
    <param from="$(var param_file)" allow_substs="true"/>
  </node>
  <node pkg="{LOADER}" exec="autoware_lanelet2_map_loader" name="lanelet2_map_loader"/>
</launch>
"""
LOADER_PARAMETERS = """\
/**:
  ros__parameters:
    enable_whole_load: true
    enable_downsampled_whole_load: true
    leaf_size: 3.0
    pcd_paths_or_directory: [$(var pointcloud_map_path)]
    pcd_metadata_path: none.yaml
"""


@pytest.fixture
def autoware(tmp_path: Path) -> Path:
    """Return a prefix in which Autoware's package is installed."""
    prefix = tmp_path / "autoware"
    share = prefix / "share" / PACKAGE
    files = {
        share / "package.xml": f"<package><name>{PACKAGE}</name></package>",
        share / "launch" / "ndt_scan_matcher.launch.xml": LAUNCH_FILE,
        share / "config" / "ndt_scan_matcher.param.yaml": PARAMETERS,
        prefix / "share/ament_index/resource_index/packages" / PACKAGE: "",
        prefix / "lib" / PACKAGE / f"{PACKAGE}_node": "#!/bin/sh\necho Autoware's own\n",
    }
    share = prefix / "share" / LOADER
    files |= {
        share / "package.xml": f"<package><name>{LOADER}</name></package>",
        share / "launch" / "pointcloud_map_loader.launch.xml": LOADER_LAUNCH_FILE,
        share / "config" / "loader.param.yaml": LOADER_PARAMETERS,
        prefix / "share/ament_index/resource_index/packages" / LOADER: "",
    }
    for program in ("autoware_pointcloud_map_loader", "autoware_lanelet2_map_loader"):
        path = prefix / "lib" / LOADER / program
        files[path] = f"#!/bin/sh\necho {program} of Autoware\n"
    for path, text in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        if path.parent.parent.name == "lib":
            path.chmod(0o755)
    return prefix


def test_the_map_loader_too_where_it_is_asked_for(start, platform, tmp_path, autoware):
    """Autoware's leaf size applies to the downsampled map only; other packages stay Autoware's."""
    overlay, points = tmp_path / "overlay", np.float32(np.mgrid[0:9, 0:9, 0:1].reshape(3, -1).T)
    write_points(tmp_path / "map.npz", points)
    sourced = {"AMENT_PREFIX_PATH": str(autoware)}
    made = start(manycore_command("ndt", "overlay", overlay, "--map-loader"), **sourced)
    assert made.wait() == 0, made
    launch_file = overlay / "share" / LOADER / "launch" / "pointcloud_map_loader.launch.xml"
    mapfile = tmp_path / "map.yaml"
    arguments = f"{{pointcloud_map_path: {tmp_path}/map.npz}}"
    mapfile.write_text(
        f"launch_path: {launch_file}\nlaunch_arguments: {arguments}\nnodes:\n"
        "  pointcloud_map_loader: {cluster: 1, core: 1}\n"
        "  lanelet2_map_loader: {cluster: 1, core: 2}\n"
    )
    line = f'. {overlay}/setup.sh && exec "$@"'
    run = start(["sh", "-c", line, "sh", *manycore_command("run", mapfile)], **sourced)
    run.wait_for("autoware_lanelet2_map_loader of Autoware")
    widths = {"/map/pointcloud_map": 81, "/output/debug/downsampled_pointcloud_map": 9}
    for topic, width in widths.items():
        durable = ("--qos-durability", "transient_local", "--qos-reliability", "reliable")
        echo = ("topic", "echo", topic, CLOUD, "--once", "--field", "width", *durable)
        heard = start(manycore_command(*echo))
        assert heard.wait() == 0, heard
        assert str(width) in heard.output.split()
    assert "autoware_pointcloud_map_loader of Autoware" not in run.output
    assert run.stop() == 0, run


def test_the_launch_file_starts_our_node(start, platform, tmp_path, autoware):
    """Unmodified, with Autoware's parameter file; without the overlay, Autoware."""
    overlay = tmp_path / "overlay"
    sourced = {"AMENT_PREFIX_PATH": str(autoware)}
    for _ in range(2):  # again over what is there
        made = start(manycore_command("ndt", "overlay", overlay), **sourced)
        assert made.wait() == 0, made
        assert f"launch and parameter files of {autoware}" in made.output
    launch_file = overlay / "share" / PACKAGE / "launch" / "ndt_scan_matcher.launch.xml"
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        f"launch_path: {launch_file}\nnodes:\n  ndt_scan_matcher: {{cluster: 1, core: 1}}\n"
    )
    assert os.path.samefile(launch_file, autoware / launch_file.relative_to(overlay))
    line = f'. {overlay}/setup.sh && exec "$@"'
    run = start(["sh", "-c", line, "sh", *manycore_command("run", mapfile)], **sourced)
    run.wait_for("ndt_scan_matcher started")
    ask = manycore_command("param", "get", "/ndt_scan_matcher", "ndt.resolution")
    answers = []
    while not answers or answers[-1].wait() != 0:  # until the node has come up
        assert run.is_running(), run
        answers.append(start(ask))
    assert "3.0" in answers[-1].output
    assert "Autoware's own" not in run.output
    assert run.stop() == 0, run


def test_without_autoware_there_is_no_launch_file(start, tmp_path):
    made = start(manycore_command("ndt", "overlay", tmp_path / "overlay"))
    assert made.wait() == 0, made
    assert "no Autoware is sourced" in made.output
    assert not (tmp_path / "overlay" / "share" / PACKAGE / "launch").exists()
    missing = start(manycore_command("ndt", "overlay", tmp_path / "none" / "overlay"))
    assert missing.wait() == 2
    assert "there is no directory" in missing.output
