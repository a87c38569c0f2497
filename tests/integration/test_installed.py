# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The installed wheel, used in directories with files that are named like modules."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from support import REPOSITORY, wait_until
from support.installs.installing import Installation, run
from support.processes.platforms import environment
from support.processes.program import Program

pytestmark = [pytest.mark.integration, pytest.mark.long]

HOSTILE = (
    *("random", "yaml", "logging", "rclpy", "types", "numpy", "signal", "selectors", "json"),
    *("socket", "click", "rich", "rmw_manycore_py", "rmw_manycore_bridge", "std_msgs", "enum"),
)
# Every kind of our programs that a run starts: nodes, the bridge, workers.
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
STRING = "std_msgs/msg/String"
PUBLISH_ONCE = ("--once", "-w", "0")
Start = Callable[..., Program]


class Place:
    """A working directory and an installation that is used in it."""

    def __init__(self, installation: Installation, directory: Path, start: Start) -> None:
        self.installation = installation
        self.directory = directory
        self.variables: dict[str, str] = {}
        self._start = start

    def start(self, *words: str | Path) -> Program:
        """Start `manycore`."""
        command = [self.installation.manycore, *words]
        return self._start(command, directory=self.directory, **self.variables)

    def run(self, *words: str | Path) -> str:
        """Run `manycore` and return its output."""
        program = self.start(*words)
        assert program.wait() == 0, program
        return program.output


@pytest.fixture(
    params=[
        pytest.param("checkout", marks=pytest.mark.stress),
        "empty folder",
        "hostile folder",
        pytest.param("hostile PYTHONPATH", marks=pytest.mark.stress),
    ]
)
def place(
    request: pytest.FixtureRequest, tmp_path: Path, installation: Installation, start: Start
) -> Place:
    """A directory whose files must not be imported instead of what is installed."""
    place = Place(installation, tmp_path / "here", start)
    place.directory.mkdir()
    if request.param == "checkout":
        for name in ("rmw_manycore_py", "bridge", "mapfiles", "launch_scripts", "startup"):
            sources = shutil.ignore_patterns("__pycache__", "*.so")
            shutil.copytree(REPOSITORY / name, place.directory / name, ignore=sources)
    elif request.param.startswith("hostile"):
        for name in HOSTILE:
            file = place.directory / f"{name}.py"
            file.write_text(f"raise SystemError('{name} of the folder')\n")
    if request.param == "hostile PYTHONPATH":
        place.variables["PYTHONPATH"] = ":"  # an empty entry means the working directory
    return place


def workers(installation: Installation) -> list[Path]:
    """Return the scan matching workers that run from this installation."""
    own = str(installation.directory / "lib/rmw_manycore/manycore_ndt_worker")
    return [path for path in Path("/proc").glob("[0-9]*") if _executable(path) == own]


def _executable(process: Path) -> str:
    try:
        return os.readlink(process / "exe")
    except OSError:  # it has ended
        return ""


def test_a_run_with_bridge_and_workers(place: Place) -> None:
    (place.directory / "map.yaml").write_text(MAPFILE)
    nodes = place.start("run", "map.yaml")
    nodes.wait_for("I heard")
    wait_until(lambda: len(workers(place.installation)) == 2, "the matcher has its workers")
    place.start("topic", "echo", "--outside", "/chatter").wait_for("Hello World")
    assert [row["alive"] for row in json.loads(place.run("bridge", "status", "--json"))] == [True]
    assert nodes.stop() == 0, nodes
    assert "is started again" not in nodes.output
    assert "of the folder" not in nodes.output


def test_the_tools(place: Place, start: Start, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    talker = [place.installation.python, "-m", "rmw_manycore_py.examples.talker"]
    start(talker, directory=tmp_path / "empty").wait_for("Publishing")
    assert "/chatter" in place.run("topic", "list").split()
    assert "Hello World" in place.run("topic", "echo", "--once", "/chatter")
    assert "lamp" in place.run("topic", "pub", *PUBLISH_ONCE, "/name", STRING, "data: lamp")
    assert "examples.talker" in place.run("status")
    assert "rclpy uses rmw_manycore" in place.run("doctor")
    assert "drive.npz" in place.run("ndt", "simulate", "--length", "5", "street")


def test_a_bridge_of_its_own(place: Place, platform: str) -> None:
    domain = int(environment(platform)["ROS_DOMAIN_ID"])
    text = BRIDGE.format(inside=domain + 1, outside=domain)
    (place.directory / "bridge.yaml").write_text(text)
    bridge = place.start("bridge", "bridge.yaml", "--inside", str(domain + 1))
    place.start("topic", "pub", "-r", "10", "/chatter", STRING, "data: carried")
    place.start("topic", "echo", "--outside", "/chatter").wait_for("carried")
    assert bridge.stop() == 0, bridge
    assert "is started again" not in bridge.output


@pytest.mark.parametrize("place", ["checkout", "empty folder"], indirect=True)
def test_the_examples_as_modules(place: Place, start: Start) -> None:
    """With Python's own rules, so not among files that are named like modules."""
    talker, listener = (
        [place.installation.python, "-m", f"rmw_manycore_py.examples.{name}"]
        for name in ("talker", "listener")
    )
    start(talker, directory=place.directory)
    start(listener, 2, directory=place.directory).wait_for("I heard")


@pytest.fixture
def examples(place: Place) -> Path:
    """The numbered examples, copied out of the repository."""
    return Path(shutil.copytree(REPOSITORY / "examples", place.directory / "examples"))


@pytest.mark.parametrize("place", ["empty folder"], indirect=True)
def test_the_examples_of_the_python_api(place: Place, start: Start, examples: Path) -> None:
    """Each public module, and a run with nodes and programs of ours."""

    def begin(name: str) -> Program:
        return start([place.installation.python, examples / name], directory=place.directory)

    begin("03_publish_arrays.py")
    programs = [begin("04_take_arrays.py"), begin("05_align_a_scan.py")]
    for program in programs:
        assert program.wait() == 0, program
    assert "cloud 9: (1000, 3)" in programs[0].output
    assert "converged: True" in programs[1].lines
    transfers = begin("07_transfers.py")
    assert transfers.wait() == 0, transfers
    pipeline = begin("06_pipeline.py")
    pipeline.wait_for(r"display \| image 30: ")
    assert pipeline.wait() == 0, pipeline


@pytest.mark.parametrize("place", ["empty folder"], indirect=True)
def test_users_of_the_python_api_have_types(place: Place, examples: Path) -> None:
    python = ["--python-executable", place.installation.python]
    for example in sorted(examples.glob("*.py")):  # numbers are no names of modules
        example.rename(example.with_name(f"example_{example.name}"))
    command = [sys.executable, "-m", "mypy", "--strict", *python]
    run(*command, *sorted(examples.glob("*.py")), cwd=place.directory)


def test_messages_are_found_on_pythonpath(
    installation: Installation, start: Start, tmp_path: Path
) -> None:
    installation.install("--no-deps", "--prefix", tmp_path, TEST_MSGS)
    folder = next(tmp_path.glob("lib/python*/site-packages"))
    (folder / "random.py").write_text("raise SystemError('random of the folder')\n")
    libraries = ":".join(map(str, [tmp_path / "lib", *folder.glob("*.libs")]))
    found = {"PYTHONPATH": str(folder), "LD_LIBRARY_PATH": libraries}
    topic = [installation.manycore, "topic"]
    publish = ["pub", "-r", "10", "/strings", "test_msgs/msg/Strings", "string_value: found"]
    start([*topic, *publish], **found)
    echo = start([*topic, "echo", "/strings", "test_msgs/msg/Strings"], **found)
    echo.wait_for("string_value: found")


def test_a_node_keeps_the_rules_of_python(
    installation: Installation, start, tmp_path: Path
) -> None:
    (tmp_path / "helper.py").write_text("NAME = 'beside the node'\n")
    (tmp_path / "named.py").write_text("import helper, os; print(helper.NAME, os.getcwd())\n")
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("nodes: {node: {module: named, cluster: 1}}\n")
    nodes = start([installation.manycore, "run", mapfile], directory=Path("/"))
    assert nodes.wait() == 0, nodes
    assert f"beside the node {tmp_path}" in nodes.output
