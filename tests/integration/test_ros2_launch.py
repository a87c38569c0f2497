# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The extensions under real launch, launch_ros and ros2cli; skipped where these are missing."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from rmw_manycore_py.native import _transport
from support import IS_MANYCORE, wait_until
from support.installs import ros2_packages
from support.nodes.bridging import Bridge
from support.nodes.speakers import hear
from support.processes.platforms import environment
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="extensions are part of rmw_manycore"),
    pytest.mark.skipif(not ros2_packages.are_available(), reason=ros2_packages.REASON),
]

LAUNCH_FILE = """\
from launch import LaunchDescription
from launch.actions import SetEnvironmentVariable
from launch_ros.actions import LifecycleNode, Node

def talker(**more):
    return Node(package="rmw_manycore", executable="talker", output="screen", **more)

def generate_launch_description():
    return LaunchDescription([
        SetEnvironmentVariable("MANYCORE_CLUSTER", "4"),
        {nodes}
    ])
"""
CPUS = sorted(os.sched_getaffinity(0))
Launch = Callable[..., Program]


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment in which `ros2` finds its parts."""
    if ros2_packages.are_installed():
        return {"PATH": ros2_packages.search_path()}
    return ros2_packages.install(tmp_path_factory.mktemp("ros2"))


@pytest.fixture
def ros2(start, found, platform) -> Launch:
    """Return the command of `ros2` with these arguments."""

    def start_ros2(*words: str | Path, directory: Path, **env: str) -> Program:
        program = shutil.which("ros2", path=found["PATH"]) or "ros2"
        return start([sys.executable, program, *words], directory=directory, **found, **env)

    return start_ros2


@pytest.fixture
def launch(ros2, tmp_path: Path) -> Launch:
    """Return the command that launches nodes with a mapfile."""

    def launch_nodes(nodes: str, mapfile: str, *arguments: str, **env: str) -> Program:
        (tmp_path / "demo.launch.py").write_text(LAUNCH_FILE.format(nodes=nodes))
        (tmp_path / "map.yaml").write_text(mapfile)
        variables = {"MANYCORE_MAPFILE": "map.yaml", "ROS_LOG_DIR": str(tmp_path / "log"), **env}
        words = ("launch", "./demo.launch.py", *arguments)
        return ros2(*words, directory=tmp_path, **variables)

    return launch_nodes


def processes(platform: str) -> dict[str, _transport.ProcessInfo]:
    """Return the living processes of a platform by the full names of their nodes."""
    try:
        with _transport.Platform(platform) as view:
            alive = {one.slot: one for one in view.processes() if one.alive}
            nodes = view.nodes()
    except _transport.PlatformError:
        return {}
    return {
        f"{node.namespace.rstrip('/')}/{node.name}": alive[node.process]
        for node in nodes
        if node.process in alive
    }


def cores(platform: str) -> set[tuple[int, int | None]]:
    """Return clusters and cores of all living processes."""
    with _transport.Platform(platform) as view:
        return {(one.cluster, one.core) for one in view.processes() if one.alive}


def place(process: _transport.ProcessInfo) -> tuple[int, int | None, list[int]]:
    """Return cluster, core, and the CPU affinity of every thread of a process."""
    threads = os.listdir(f"/proc/{process.pid}/task")
    cpus = {cpu for thread in threads for cpu in os.sched_getaffinity(int(thread))}
    return process.cluster, process.core, sorted(cpus)


def test_nodes_of_a_launch_file_run_where_the_mapfile_places_them(launch, platform) -> None:
    mapfile = (
        f"platform: {{profile: coolidge, name: {platform}}}\nnodes:\n"
        f"  one: {{cluster: 2, core: 3, host_cpu: {CPUS[-1]}}}\n"
        f"  /robot/two: {{cluster: 3, core: 1, host_cpu: {CPUS[0]}, env: {{DEMO: mapfile}}}}\n"
        f"  two_2: {{cluster: 1, core: 5, host_cpu: {CPUS[0]}}}\n"
        "  absent: {cluster: 1}\n"
    )
    nodes = (
        f'talker(name="one", respawn=True, prefix="taskset -c {CPUS[0]}"), '
        'talker(name="two", namespace="robot", additional_env={"DEMO": "launch file"}), '
        'Node(package="rmw_manycore", executable="listener", name="two"), '
        'talker(name="two", namespace="other"), talker(name="three"), '
        'talker(name="two", namespace="/", exec_name="again")'
    )
    run = launch(nodes, mapfile, MANYCORE_PLATFORM=platform)
    run.wait_for(r"/three is not in the mapfile: it is not pinned")
    expected = {
        "/one": (2, 3, [CPUS[-1]]),
        "/robot/two": (3, 1, [CPUS[0]]),
        "/three": (4, None, CPUS),
    }
    names = {*expected, "/two", "/other/two"}
    wait_until(lambda: names <= processes(platform).keys(), "five names of nodes")
    there = processes(platform)
    assert {name: place(there[name]) for name in expected} == expected
    variables = Path(f"/proc/{there['/robot/two'].pid}/environ").read_bytes().split(b"\0")
    assert b"DEMO=mapfile" in variables
    wait_until(lambda: (1, 5) in cores(platform), "the second node of a name")
    with _transport.Platform(platform) as view:
        assert (view.info().clusters, view.info().cores_per_cluster) == (5, 16)
        assert view.info().smem_bytes == 4 << 20
    os.kill(there["/one"].pid, signal.SIGKILL)
    run.wait_for(r"process has died \[pid \d+, exit code -9")
    wait_until(lambda: "/one" in processes(platform), "the respawned node")
    assert place(processes(platform)["/one"]) == expected["/one"]
    run.stop()
    assert "not started by the launch file: absent" in run.output


def test_the_platform_is_there_before_launch_has_a_node_itself(launch, platform) -> None:
    mapfile = f"platform: {{clusters: 4, name: {platform}}}\nnodes:\n  arm: {{cluster: 3}}\n"
    nodes = 'LifecycleNode(package="rmw_manycore", executable="talker", name="arm", namespace="/")'
    run = launch(nodes, mapfile)
    wait_until(lambda: "/arm" in processes(platform), "the node")
    assert place(processes(platform)["/arm"])[0] == 3
    run.stop()


@pytest.mark.parametrize(
    ("mapfile", "complaint"),
    [
        ("nodes:\n  one: {cluster: 9}\n", r"map.yaml:2: nodes.one.cluster: expected 1 to 5"),
        (
            "nodes:\n  one: {cluster: 1, parameters: {a: 1}}\n",
            r"map.yaml:2: nodes.one.parameters: expected no key that says how a node is started",
        ),
    ],
)
def test_a_wrong_mapfile_starts_nothing(launch, platform, mapfile, complaint) -> None:
    run = launch('talker(name="one"), talker(name="two")', mapfile)
    run.wait_for(complaint)
    assert run.wait() == 1
    assert "process started" not in run.output


def test_of_two_nodes_that_a_name_means_the_first_is_placed(launch, platform) -> None:
    mapfile = f"platform: {{name: {platform}}}\nnodes:\n  two: {{cluster: 3, core: 2}}\n"
    nodes = 'talker(name="two", namespace="left"), talker(name="two", namespace="right")'
    run = launch(nodes, mapfile)
    run.wait_for(
        "nodes.two: expected a name that one node of the launch file has, found several: "
        "/left/two, /right/two; the last one is not pinned"
    )
    wait_until(lambda: len(processes(platform)) == 2, "two nodes")
    assert place(processes(platform)["/left/two"])[:2] == (3, 2)
    assert place(processes(platform)["/right/two"]) == (4, None, CPUS)
    run.stop()
    assert "leaked" not in run.output


def test_a_mapfile_for_another_middleware_is_refused(launch, platform) -> None:
    mapfile = "nodes:\n  one: {cluster: 1}\n"
    run = launch('talker(name="one")', mapfile, RMW_IMPLEMENTATION="rmw_fastrtps_cpp")
    run.wait_for(r"expected RMW_IMPLEMENTATION=rmw_manycore, found rmw_fastrtps_cpp")
    assert run.wait() == 1


def test_without_a_mapfile_nothing_is_different(launch, platform) -> None:
    run = launch('talker(name="one")', "", MANYCORE_MAPFILE="")
    wait_until(lambda: "/one" in processes(platform), "the node")
    assert place(processes(platform)["/one"]) == (4, None, CPUS)
    run.stop()
    assert "manycore]" not in run.output


def test_what_crosses_crosses(launch, platform, bridge: Bridge) -> None:
    mapfile = (
        f"platform: {{name: {platform}}}\nnodes:\n"
        "  one: {cluster: 1, topic_to: {/chatter: std_msgs/msg/String}}\n"
    )
    run = launch('talker(name="one")', mapfile)
    outside = bridge.outside(hear, "/chatter", {})
    outside.wait_for("Hello World")
    run.stop()


def test_verbs_of_manycore_are_verbs_of_ros2(ros2, found, platform, tmp_path: Path) -> None:
    run = ros2("manycore", "status", "--platform", platform, directory=tmp_path)
    assert run.wait() == 1
    assert f"no platform '{platform}'" in run.output
    assert ros2("manycore", "status", directory=tmp_path).wait() == 0
    assert ros2("manycore", "map", "check", "none.yaml", directory=tmp_path).wait() == 2
    run = ros2("manycore", "map", "check", "talker_listener", directory=tmp_path)
    assert run.wait() == 0
    assert "2 nodes in 2 clusters" in run.output
    run = ros2("manycore", "topic", "echo", "--once", "/chatter", directory=tmp_path)
    run.stop()
    assert ros2("manycore", "topic", "--help", directory=tmp_path).wait() == 0


def test_without_ros2_the_entry_points_do_nothing(platform) -> None:
    code = (
        "import importlib.metadata as m; e = m.entry_points();"
        "print([p.name for g in ('launch_ros.node_action', 'ros2cli.command')"
        " for p in e.select(group=g) if 'rmw_manycore' in p.value])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=environment(platform)
    )
    assert done.stdout.strip() == "['manycore', 'manycore']"
