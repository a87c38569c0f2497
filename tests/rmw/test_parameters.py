# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of a node in another process: its services, its events, its start."""

from __future__ import annotations

import pytest
import rclpy
from rcl_interfaces.msg import ParameterEvent
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient

from support import TIMEOUT_S
from support.nodes.ros import spin_until
from support.peers.programs import forked_example


@pytest.fixture
def controller(node, start, peer_cluster):
    """Start the example controller and return a client of its parameters."""
    start(forked_example("controller"), peer_cluster).wait_for("gain is")
    client = AsyncParameterClient(node, "controller")
    assert client.wait_for_services(TIMEOUT_S)
    return client


def answer(node, future):
    spin_until(node, future.done)
    return future.result()


def test_get_and_list(node, controller):
    listed = answer(node, controller.list_parameters([], 10)).result.names
    assert {"gain", "use_sim_time"} <= set(listed)
    values = answer(node, controller.get_parameters(["gain"])).values
    assert values[0].double_value == 1.0


def test_describe(node, controller):
    description = answer(node, controller.describe_parameters(["gain"])).descriptors[0]
    assert description.description == "Proportional gain"
    assert description.floating_point_range[0].to_value == 10.0


def test_set(node, controller):
    results = answer(node, controller.set_parameters([Parameter("gain", value=3.5)])).results
    assert results[0].successful
    assert answer(node, controller.get_parameters(["gain"])).values[0].double_value == 3.5


def test_set_atomically_what_is_out_of_range(node, controller):
    future = controller.set_parameters_atomically([Parameter("gain", value=99.0)])
    assert not answer(node, future).result.successful
    assert answer(node, controller.get_parameters(["gain"])).values[0].double_value == 1.0


def test_changes_are_announced(node, controller):
    events = []
    node.create_subscription(ParameterEvent, "/parameter_events", events.append, 100)
    spin_until(node, lambda: node.count_publishers("/parameter_events") == 2)
    answer(node, controller.set_parameters([Parameter("gain", value=2.0)]))
    spin_until(node, lambda: any(event.node == "/controller" for event in events))


def test_from_the_command_line(start):
    program = start(forked_example("controller", "--ros-args", "-p", "gain:=4.5"), cluster=2)
    program.wait_for(r"gain is 4\.5")


def test_from_a_file(start, tmp_path):
    file = tmp_path / "parameters.yaml"
    file.write_text("controller: {ros__parameters: {gain: 6.5}}\n")
    program = start(forked_example("controller", "--ros-args", "--params-file", str(file)))
    program.wait_for(r"gain is 6\.5")


def test_of_the_own_node(node):
    node.declare_parameter("speed", 1)
    client = AsyncParameterClient(node, "tester")
    assert client.wait_for_services(TIMEOUT_S)
    answer(node, client.set_parameters([Parameter("speed", value=2)]))
    assert node.get_parameter("speed").value == 2
    assert rclpy.ok()
