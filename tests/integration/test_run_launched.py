# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore run` beyond starting nodes: components, order and exit actions of launch files."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

# Serves like rclcpp's component_container, which no wheel has; plugins are functions here.
CONTAINER = """\
#!{python}
import rclpy
from composition_interfaces.srv import LoadNode
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String

def speaker(node):
    words = node.declare_parameter("words", "").value
    publisher = node.create_publisher(String, "chatter", 1)
    node.create_timer(0.1, lambda: publisher.publish(String(data=words)))

def hearer(node):
    node.create_subscription(String, "chatter", lambda m: print("heard", m.data, flush=True), 1)

def load(request, response):
    plugin = {{"demo::Speaker": speaker, "demo::Hearer": hearer}}.get(request.plugin_name)
    if plugin is None:
        response.error_message = "no such plugin"
        return response
    overrides = [Parameter.from_parameter_msg(p) for p in request.parameters]
    rules = [word for rule in request.remap_rules for word in ("-r", rule)]
    node = Node(request.node_name, namespace=request.node_namespace, parameter_overrides=overrides,
                cli_args=["--ros-args", *rules], use_global_arguments=False)
    plugin(node)
    executor.add_node(node)
    response.success, response.full_node_name = True, node.get_fully_qualified_name()
    return response

rclpy.init()
executor = SingleThreadedExecutor()
container = Node("container")
container.create_service(LoadNode, "~/_container/load_node", load)
executor.add_node(container)
try:
    executor.spin()
except (ExternalShutdownException, KeyboardInterrupt):
    pass
"""
COMPONENTS = """\
<launch>
  <arg name="words"/>
  <node_container pkg="demo" exec="container" name="box" namespace="left" respawn="true">
    <composable_node pkg="demo" plugin="demo::Speaker" name="speaker">
      <param name="words" value="$(var words)"/><remap from="chatter" to="/talk"/>
    </composable_node>
  </node_container>
  <load_composable_node target="/left/box">
    <composable_node pkg="demo" plugin="demo::{hearer}" name="hearer" namespace="/right">
      <remap from="chatter" to="/talk"/>
    </composable_node>
  </load_composable_node>
</launch>
"""
ORDER = """\
from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import Shutdown

def process(name, code, **options):
    return ExecuteProcess(cmd=["sh", "-c", code], name=name, **options)

def generate_launch_description():
    stays = process("stays", "sleep 1000")
    enough = "until test $(wc -l < tries) -ge 3; do sleep 0.01; done"
    last = process("last", enough, on_exit=[EmitEvent(event=Shutdown(reason="done"))])
    tries = "echo x >> tries; test $(wc -l < tries) -ge 3"
    again = process("again", tries, respawn=True, respawn_max_retries=2)
    return LaunchDescription([
        RegisterEventHandler(OnProcessExit(target_action=again, on_exit=[stays])),
        RegisterEventHandler(OnProcessStart(
            target_action=stays, on_start=[TimerAction(period=0.1, actions=[last])])),
        again,
    ])
"""

MANAGED = """\
#!{python}
import rclpy
from lifecycle_msgs.srv import ChangeState
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

def change(request, response):
    response.success = True
    return response

rclpy.init()
node = Node("managed")
node.create_service(ChangeState, "~/change_state", change)
try:
    rclpy.spin(node)
except (ExternalShutdownException, KeyboardInterrupt):
    pass
"""
AUTOSTART = """\
from launch import LaunchDescription
from launch_ros.actions import LifecycleNode

def generate_launch_description():
    return LaunchDescription([
        LifecycleNode(package="demo", executable="container", name="arm", namespace="left",
                      autostart=True)])
"""


def events(program: Program, kind: str) -> list[dict[str, Any]]:
    lines = (json.loads(line) for line in program.lines if line.startswith("{"))
    return [event for event in lines if event["event"] == kind]


@pytest.fixture
def container(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Install the package `demo` with its container; return the prefix."""
    index = tmp_path / "prefix/share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "demo").touch()
    program = tmp_path / "prefix/lib/demo/container"
    program.parent.mkdir(parents=True)
    program.write_text(CONTAINER.format(python=sys.executable))
    program.chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    return tmp_path


def write(directory: Path, launch: str, text: str, nodes: str, arguments: str = "{}") -> Path:
    (directory / launch).write_text(text)
    mapfile = directory / "map.yaml"
    mapfile.write_text(
        f"launch_path: {launch}\nlaunch_arguments: {arguments}\nallow_shared_cores: true\n"
        f"nodes:\n{nodes}"
    )
    return mapfile


def test_a_container_loads_its_components_each_time_it_starts(start, container, platform) -> None:
    text = COMPONENTS.format(hearer="Hearer")
    nodes = "  box: {cluster: 1, core: 1}\n"
    mapfile = write(container, "demo.launch.xml", text, nodes, "{words: hello}")
    run = start(forked_manycore("run", mapfile, "--json"))
    for _ in range(2):
        match = run.wait_for(r'"started", "node": "box", "pid": (\d+)')
        run.wait_for(r'"\(components of box\)", "line": "loaded /speaker into /left/box"')
        run.wait_for(r'"\(components of box\)", "line": "loaded /right/hearer into /left/box"')
        run.wait_for(r'"node": "box", "line": "heard hello"')
        os.kill(int(match[1]), signal.SIGKILL)
    run.wait_for('"started", "node": "box"')
    assert run.stop() == 0


def test_a_component_that_is_not_loaded_fails_the_run(start, container, platform) -> None:
    text = COMPONENTS.format(hearer="Absent")
    nodes = "  box: {cluster: 1, core: 1}\n"
    mapfile = write(container, "demo.launch.xml", text, nodes, "{words: hello}")
    run = start(forked_manycore("run", mapfile))
    run.wait_for(r"hearer was not loaded into /left/box: no such plugin$")
    run.wait_for(r"^manycore \| \(components of box\) failed: exit status 1$")
    assert run.stop() == 1


def test_a_lifecycle_node_is_configured_and_activated(start, container, platform) -> None:
    program = container / "prefix/lib/demo/container"
    program.write_text(MANAGED.format(python=sys.executable))
    nodes = "  arm: {cluster: 1, core: 1}\n"
    run = start(forked_manycore("run", write(container, "demo.launch.py", AUTOSTART, nodes)))
    for transition in (1, 3):
        run.wait_for(rf"^\(states of arm\) \| /left/arm made transition {transition}$")
    assert run.stop() == 0


def test_what_waits_for_a_process_starts_and_ends_with_it(start, tmp_path, platform) -> None:
    nodes = "".join(f"  {name}: {{cluster: 1, core: 1}}\n" for name in ("stays", "last", "again"))
    run = start(forked_manycore("run", write(tmp_path, "demo.launch.py", ORDER, nodes), "--json"))
    assert run.wait() == 0
    order = [event["node"] for event in events(run, "started")]
    assert order[0] == "again"
    assert (order.count("again"), order.index("stays") < order.index("last")) == (3, True)
    assert [event["reason"] for event in events(run, "stopping")] == ["last has ended"]
    assert len((tmp_path / "tries").read_text().split()) == 3
