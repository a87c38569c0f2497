# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages and services that the project builds from definitions work like those of ROS 2."""

from __future__ import annotations

import pytest
import rclpy
from autoware_internal_debug_msgs.msg import Float32Stamped, Int32Stamped
from geometry_msgs.msg import TransformStamped
from rclpy.action import ActionClient, ActionServer
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error, TFMessage
from tf2_msgs.srv import FrameGraph
from tier4_localization_msgs.srv import PoseWithCovarianceStamped

from support import TIMEOUT_S
from support.nodes.ros import announce, peer_node, spin_until


def some_messages() -> list[object]:
    transforms = [TransformStamped(child_frame_id=name) for name in ("base_link", "lidar")]
    transforms[1].transform.translation.z = 1.5
    stamped = [Float32Stamped(data=2.5), Int32Stamped(data=-7)]
    for message in stamped:
        message.stamp.sec = 3
    return [TFMessage(transforms=transforms), *stamped]


def echo() -> None:
    """Send back every message, and the pose of every request."""
    with peer_node("echo") as node:
        for message in some_messages():
            name = type(message).__name__
            publisher = node.create_publisher(type(message), f"{name}_back", 10)
            node.create_subscription(type(message), f"{name}_there", publisher.publish, 10)
        node.create_service(PoseWithCovarianceStamped, "pose", same_pose)
        node.create_service(FrameGraph, "frames", graph)
        action_server = ActionServer(node, LookupTransform, "lookup", look_up)
        announce("ready")
        rclpy.spin(node)
        action_server.destroy()


def graph(_: FrameGraph.Request, response: FrameGraph.Response) -> FrameGraph.Response:
    response.frame_yaml = "base_link: {parent: map}"
    return response


def look_up(goal: object) -> LookupTransform.Result:
    goal.succeed()
    result = LookupTransform.Result(error=TF2Error(error=TF2Error.TIMEOUT_ERROR))
    result.transform.child_frame_id = goal.request.target_frame
    return result


def same_pose(
    request: PoseWithCovarianceStamped.Request, response: PoseWithCovarianceStamped.Response
) -> PoseWithCovarianceStamped.Response:
    response.reliable = True
    response.pose_with_covariance = request.pose_with_covariance
    return response


@pytest.mark.parametrize("message", some_messages(), ids=lambda m: type(m).__name__)
def test_a_message_there_and_back(node, start_peer, message):
    heard = []
    name = type(message).__name__
    node.create_subscription(type(message), f"{name}_back", heard.append, 10)
    publisher = node.create_publisher(type(message), f"{name}_there", 10)
    start_peer(echo, cluster=2).wait_for("ready")
    spin_until(node, publisher.get_subscription_count)
    spin_until(node, lambda: publisher.publish(message) or heard)
    assert heard[0] == message


def test_a_service(node, start_peer):
    start_peer(echo, cluster=2)
    client = node.create_client(PoseWithCovarianceStamped, "pose")
    assert client.wait_for_service(TIMEOUT_S)
    request = PoseWithCovarianceStamped.Request()
    request.pose_with_covariance.header.frame_id = "map"
    request.pose_with_covariance.pose.covariance[35] = 0.25
    answer = client.call_async(request)
    spin_until(node, answer.done)
    response = answer.result()
    assert (response.success, response.reliable) == (False, True)
    assert response.pose_with_covariance == request.pose_with_covariance


def test_what_the_python_library_of_tf2_imports(node, start_peer):
    """Our tf2_msgs hides one that the user builds, so ours has all of the published types."""
    start_peer(echo, cluster=2)
    frames = node.create_client(FrameGraph, "frames")
    assert frames.wait_for_service(TIMEOUT_S)
    answer = frames.call_async(FrameGraph.Request())
    spin_until(node, answer.done)
    assert answer.result().frame_yaml == "base_link: {parent: map}"
    client = ActionClient(node, LookupTransform, "lookup")
    assert client.wait_for_server(TIMEOUT_S)
    accepted = client.send_goal_async(LookupTransform.Goal(target_frame="lidar"))
    spin_until(node, accepted.done)
    done = accepted.result().get_result_async()
    spin_until(node, done.done)
    result = done.result().result
    assert result.transform.child_frame_id == "lidar"
    assert result.error.error == TF2Error.TIMEOUT_ERROR
    client.destroy()
