# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import os
import stat
import subprocess
from pathlib import Path

import pytest
import yaml

from rmw_manycore_py.create import create
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import check
from support import MAPFILES

pytestmark = pytest.mark.unit

# Prints its command line and environment; the topics are for the topic table.
NODE = """\
import json, os, sys
def never():
    class A(Node):
        def __init__(self):
            from std_msgs.msg import String
            self.create_{kind}(String, "chatter", 10)
print(json.dumps({{
    "argv": sys.argv[1:], "cwd": os.getcwd(), "env": dict(os.environ),
    "cpus": sorted(os.sched_getaffinity(0)),
}}))
"""
MAPFILE = """\
# Comments and blank lines are not counted.

platform: {profile: coolidge, name: chip}
topics:
  /chatter: {type: std_msgs/msg/String, topic_dsm_size: 10000}
nodes:
  talker:
    cluster: 1
    script: talker.py
    namespace: /demo
    remappings: {chatter: /chatter}
    parameters: {text: it's, rate_hz: 2.0}
    param_file: talker.yaml
    env: {MOOD: quite calm}
  listener: {cluster: 2, script: listener.py}
"""


@pytest.fixture
def mapfile(tmp_path: Path) -> Path:
    (tmp_path / "talker.py").write_text(NODE.format(kind="publisher"))
    (tmp_path / "listener.py").write_text(NODE.format(kind="subscription"))
    (tmp_path / "talker.yaml").write_text("/**: {ros__parameters: {frame: map, rate_hz: 1.0}}\n")
    file = tmp_path / "mapfile.yaml"
    file.write_text(MAPFILE)
    return file


def test_the_topic_table_is_that_of_figure_7(mapfile: Path, tmp_path: Path) -> None:
    create(mapfile, tmp_path / "out")
    assert yaml.safe_load((tmp_path / "out/topic_table.yaml").read_text()) == {
        "topic_configurations": [
            {
                "topic_dsm_size": 10000,
                "topic_name": "/chatter",
                "topic_id": 1,
                "topic_type": "std_msgs/msg/String",
                "receiver_cc": [2],
            }
        ]
    }


def test_the_mapfile_of_figure_8_is_written(tmp_path: Path) -> None:
    example = MAPFILES / "talker_listener.yaml"
    create(example, tmp_path / "out")
    text = (tmp_path / "out/mapfile.yaml").read_text()
    assert "    topic_in:\n      none:\n" in text
    written = yaml.safe_load(text)
    launch = (MAPFILES / "../launch_scripts/talker_listener.launch.xml").resolve()
    assert written["launch_path"] == str(launch)
    nodes = yaml.safe_load(example.read_text())["nodes"]
    nodes["talker"]["param_file"] = "parameters/talker.yaml"  # the launch file has a parameter
    assert written["nodes"] == nodes
    again = check(tmp_path / "out/mapfile.yaml").nodes
    assert [(n.full_name, n.cluster, n.core) for n in again] == [
        ("/talker", 1, 1),
        ("/listener", 2, 1),
    ]


def test_the_mapfile_of_figure_8_names_the_parameter_files(mapfile: Path, tmp_path: Path) -> None:
    create(mapfile, tmp_path / "out")
    nodes = yaml.safe_load((tmp_path / "out/mapfile.yaml").read_text())["nodes"]
    files = nodes["talker"]["param_file"]
    assert len(files) == 2
    assert all((tmp_path / "out" / file).is_file() for file in files)
    assert set(nodes["talker"]) == {"cluster", "core", "topic_in", "topic_to", "param_file"}


def test_memory_is_set_against_the_clusters_smem(mapfile: Path, tmp_path: Path) -> None:
    create(mapfile, tmp_path / "out")
    clusters = yaml.safe_load((tmp_path / "out/memory.yaml").read_text())["clusters"]
    assert clusters[1] == {
        "smem_size": 4 << 20,
        "used": 10000,
        "free": (4 << 20) - 10000,
        "topic_dsms": {"/chatter": 10000},
    }
    assert clusters[2]["used"] == 0


def test_a_launch_script_starts_its_node_in_place(mapfile: Path, tmp_path: Path) -> None:
    report = create(mapfile, tmp_path / "out")
    script = tmp_path / "out/nodes/talker.sh"
    assert stat.S_IMODE(script.stat().st_mode) == 0o755
    done = subprocess.run(
        [script, "--more"],
        env={"PATH": os.environ["PATH"]},
        cwd="/",
        check=True,
        capture_output=True,
        text=True,
    )
    started = json.loads(done.stdout)
    out = (tmp_path / "out").resolve()
    assert started["argv"] == [
        *("--ros-args", "-r", "__node:=talker", "-r", "__ns:=/demo", "-r", "chatter:=/chatter"),
        *("--params-file", f"{out}/parameters/talker.1.yaml"),
        *("--params-file", f"{out}/parameters/talker.yaml", "--more"),
    ]
    node = report.placement.nodes[0]
    assert started["cpus"] == [node.host_cpu]
    assert started["cwd"] == str(tmp_path)
    assert {key: started["env"][key] for key in node.env} == node.env


@pytest.mark.parametrize(("created", "expected"), [(None, "0"), ("", "0"), ("7", "7")])
def test_a_launch_script_has_the_domain_that_its_node_is_placed_in(
    mapfile: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    created: str | None,
    expected: str,
) -> None:
    """Otherwise the shell decides whether a node with a domain of its own is elsewhere."""
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    if created is not None:
        monkeypatch.setenv("ROS_DOMAIN_ID", created)
    mapfile.write_text(MAPFILE.replace("MOOD: quite calm", "ROS_DOMAIN_ID: 5"))
    create(mapfile, tmp_path / "out")
    places = {
        name: environment_in(tmp_path / f"out/nodes/{name}.sh", ROS_DOMAIN_ID="5")
        for name in ("talker", "listener")
    }
    assert places["talker"] == {"ROS_DOMAIN_ID": "5", "MANYCORE_PLATFORM": ""}
    assert places["listener"] == {"ROS_DOMAIN_ID": expected, "MANYCORE_PLATFORM": "chip"}


def environment_in(script: Path, **shell: str) -> dict[str, str]:
    """Return where a node is that a script starts in a shell with these variables."""
    env = {"PATH": os.environ["PATH"], **shell}
    done = subprocess.run([script], env=env, check=True, capture_output=True, text=True)
    started = json.loads(done.stdout)["env"]
    return {name: started[name] for name in ("ROS_DOMAIN_ID", "MANYCORE_PLATFORM")}


def test_parameters_are_written_under_the_nodes_full_name(mapfile: Path, tmp_path: Path) -> None:
    create(mapfile, tmp_path / "out")
    assert yaml.safe_load((tmp_path / "out/parameters/talker.yaml").read_text()) == {
        "/demo/talker": {"ros__parameters": {"text": "it's", "rate_hz": 2.0}}
    }


def test_the_report_sets_written_lines_against_generated_ones(
    mapfile: Path, tmp_path: Path
) -> None:
    report = create(mapfile, tmp_path / "out")
    assert report.written_lines == 13
    lines = [line.strip() for file in report.files for line in file.read_text().splitlines()]
    assert report.generated_lines == sum(bool(x) and not x.startswith("#") for x in lines)
    # Two nodes, three parameters (one given twice), one topic each.
    assert report.delta_loc == 2 * 10 + 3 + 2 * 6
    assert "dLoC = 35 for 2 nodes" in report.summary


def test_what_was_created_before_is_replaced(mapfile: Path, tmp_path: Path) -> None:
    create(mapfile, tmp_path / "out")
    mapfile.write_text("nodes:\n  other: {cluster: 1, script: talker.py}\n")
    create(mapfile, tmp_path / "out")
    assert [file.name for file in (tmp_path / "out/nodes").iterdir()] == ["other.sh"]
    assert not (tmp_path / "out/parameters").exists()


def test_names_that_differ_in_a_slash_only_have_files_of_their_own(tmp_path: Path) -> None:
    (tmp_path / "talker.py").write_text(NODE.format(kind="publisher"))
    mapfile = tmp_path / "mapfile.yaml"
    node = "{{cluster: 1, core: {}, script: talker.py}}"
    names = enumerate(("a/b", "a__b", "a_b"), start=1)
    mapfile.write_text("nodes:\n" + "".join(f"  {n}: {node.format(i)}\n" for i, n in names))
    create(mapfile, tmp_path / "out")
    scripts = sorted(file.name for file in (tmp_path / "out/nodes").iterdir())
    assert scripts == ["a.b.sh", "a__b.sh", "a_b.sh"]


def test_a_directory_with_other_things_is_left_alone(mapfile: Path, tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="expected an empty directory"):
        create(mapfile, tmp_path)
    with pytest.raises(ManycoreError, match="expected a directory"):
        create(mapfile, mapfile)


def test_nothing_is_written_for_a_wrong_mapfile(mapfile: Path, tmp_path: Path) -> None:
    mapfile.write_text(MAPFILE + "  third: {cluster: 1, script: absent.py}\n")
    with pytest.raises(ManycoreError):
        create(mapfile, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_topic_table_of_somebody_else_is_left_alone(mapfile: Path, tmp_path: Path) -> None:
    directory = tmp_path / "mine"
    (directory / "nodes").mkdir(parents=True)
    (directory / "topic_table.yaml").write_text("mine: true\n")
    with pytest.raises(ManycoreError, match="expected an empty directory"):
        create(mapfile, directory)
    assert (directory / "nodes").is_dir()
