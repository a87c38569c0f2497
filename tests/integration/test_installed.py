# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The installed wheel, used in directories whose files are named like modules."""

from __future__ import annotations

import json
import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from installing import Installation, run
from support import REPOSITORY, Program, environment, wait_until

pytestmark = [pytest.mark.integration, pytest.mark.xdist_group("install")]

HOSTILE = (
    *("random", "yaml", "logging", "rclpy", "types", "numpy", "signal", "selectors", "json"),
    *("socket", "click", "rich", "rmw_manycore_py", "rmw_manycore_bridge", "std_msgs", "enum"),
)
# Every way in which a run starts programs of ours: nodes, the bridge, workers.
MAPFILE = """
platform: {profile: host, clusters: 2, cores_per_cluster: 8}
nodes:
  talker:
    package: rmw_manycore
    executable: talker
    cluster: 1
    topic_to: {chatter: std_msgs/msg/String}
  listener: {module: rmw_manycore_py.examples.listener, cluster: 2}
  ndt_scan_matcher: {module: rmw_manycore_py.ndt.nodes.ndt_scan_matcher, cluster: 2, workers: 2}
"""
BRIDGE = """
from_domain: {inside}
to_domain: {outside}
topics: {{chatter: {{type: std_msgs/msg/String}}}}
"""
TEST_MSGS = "ros-test-msgs==2.0.3"
Run = Callable[..., str]


@pytest.fixture(params=["checkout", "empty folder", "hostile folder"])
def directory(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The working directory: nothing in it may take the place of what is installed."""
    directory = tmp_path / "here"
    directory.mkdir()
    if request.param == "checkout":
        for name in ("rmw_manycore_py", "bridge", "mapfiles", "launch_scripts", "startup"):
            sources = shutil.ignore_patterns("__pycache__", "*.so")
            shutil.copytree(REPOSITORY / name, directory / name, ignore=sources)
    elif request.param == "hostile folder":
        for name in HOSTILE:
            (directory / f"{name}.py").write_text(f"raise SystemError('{name} of the folder')\n")
    return directory


@pytest.fixture(params=[None, ":"], ids=["", "empty entry in PYTHONPATH"])
def variables(request: pytest.FixtureRequest) -> dict[str, str]:
    """Variables; an empty entry of PYTHONPATH means the working directory."""
    return {"PYTHONPATH": request.param} if request.param else {}


@pytest.fixture
def manycore(installation: Installation, platform: str, directory: Path, variables) -> Run:
    """Return a function that runs a command to its end and returns what it printed."""

    def manycore(*words: str | Path) -> str:
        env = environment(platform, **variables)
        return run(installation.manycore, *words, env=env, cwd=directory)

    return manycore


def workers(installation: Installation) -> list[Path]:
    """Return the scan matching workers that run from an installation."""
    own = str(installation.directory / "lib/rmw_manycore/manycore_ndt_worker")
    return [path for path in Path("/proc").glob("[0-9]*") if _executable(path) == own]


def _executable(process: Path) -> str:
    try:
        return os.readlink(process / "exe")
    except OSError:  # it has ended
        return ""


def test_a_run_with_bridge_and_workers(
    installation: Installation, start, manycore: Run, directory: Path, variables
) -> None:
    (directory / "map.yaml").write_text(MAPFILE)
    nodes = start([installation.manycore, "run", "map.yaml"], directory=directory, **variables)
    nodes.wait_for("I heard")
    wait_until(lambda: len(workers(installation)) == 2, "the matcher has its workers")
    wait_until(lambda: routes(manycore), "the bridge counts")
    wait_until(lambda: routes(manycore)[0]["messages"], "the bridge carries")
    assert nodes.stop() == 0, nodes
    assert "is started again" not in nodes.output
    assert "of the folder" not in nodes.output


def routes(manycore: Run) -> list[dict]:
    rows = json.loads(manycore("bridge", "status", "--json"))
    return [row for row in rows if row["alive"]]


def test_the_tools(
    installation: Installation, start, manycore: Run, directory: Path, variables, tmp_path: Path
) -> None:
    (tmp_path / "empty").mkdir()
    talker = [installation.python, "-m", "rmw_manycore_py.examples.talker"]
    start(talker, directory=tmp_path / "empty").wait_for("Publishing")
    assert "/chatter" in manycore("topic", "list").split()
    assert "Hello World" in manycore("topic", "echo", "--once", "/chatter")
    assert "lamp" in manycore(
        "topic", "pub", "--once", "/name", "std_msgs/msg/String", "data: lamp"
    )
    assert "examples.talker" in manycore("status")
    assert "rclpy uses rmw_manycore" in manycore("doctor")
    assert "drive.npz" in manycore("ndt", "simulate", "--length", "5", directory / "street")


def test_a_bridge_of_its_own(
    installation: Installation, start, manycore: Run, directory: Path, variables, platform: str
) -> None:
    domain = int(environment(platform)["ROS_DOMAIN_ID"])
    (directory / "bridge.yaml").write_text(BRIDGE.format(inside=domain, outside=domain % 100 + 1))
    command = [installation.manycore, "bridge", "bridge.yaml"]
    bridge = start(command, directory=directory, **variables)
    bridge.wait_for("started")
    wait_until(lambda: bridge_is_up(manycore), "the bridge is up")
    assert bridge.stop() == 0, bridge
    assert "is started again" not in bridge.output


def bridge_is_up(manycore: Run) -> bool:
    try:
        return bool(routes(manycore))
    except AssertionError:  # the platform is not there yet
        return False


@pytest.mark.parametrize("directory", ["checkout", "empty folder"], indirect=True)
def test_the_examples_as_modules(installation: Installation, start, directory: Path) -> None:
    """With Python's own rules, so not among files that are named like modules."""
    module = "rmw_manycore_py.examples."
    start([installation.python, "-m", f"{module}talker"], directory=directory)
    listener = start([installation.python, "-m", f"{module}listener"], 2, directory=directory)
    listener.wait_for("I heard")


def test_messages_are_found_where_pythonpath_says(
    installation: Installation, platform: str, tmp_path: Path
) -> None:
    folder = tmp_path / "messages"
    run(installation.python, "-m", "pip", "install", "--no-deps", "--target", folder, TEST_MSGS)
    (folder / "random.py").write_text("raise SystemError('random of the folder')\n")
    env = environment(platform, PYTHONPATH=str(folder), LD_LIBRARY_PATH=str(folder / "lib"))
    words = ["topic", "pub", "-r", "10", "/strings", "test_msgs/msg/Strings", "string_value: found"]
    publisher = Program([installation.manycore, *words], env)
    try:
        assert "found" in run(installation.manycore, "topic", "echo", "--once", "/strings", env=env)
    finally:
        publisher.signal(signal.SIGINT)
        publisher.wait()
        publisher.kill()


def test_a_node_keeps_the_rules_of_python(
    installation: Installation, start, tmp_path: Path
) -> None:
    (tmp_path / "helper.py").write_text("NAME = 'beside the node'\n")
    (tmp_path / "named.py").write_text("import helper, os; print(helper.NAME, os.getcwd())\n")
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("nodes: {node: {module: named, cluster: 1, ros_arguments: false}}\n")
    nodes = start([installation.manycore, "run", mapfile], directory=Path("/"))
    assert nodes.wait() == 0, nodes
    assert f"beside the node {tmp_path}" in nodes.output
