# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Activation of `ndt_scan_matcher`, and its search for an initial pose."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from autoware_internal_localization_msgs.srv import PoseWithCovarianceStamped as AlignService
from std_srvs.srv import SetBool
from tier4_localization_msgs.srv import PoseWithCovarianceStamped as Tier4AlignService
from visualization_msgs.msg import MarkerArray

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.messages.conversions import matrix_of, pose_with_covariance
from support import TIMEOUT_S
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    COVARIANCE,
    NEAR,
    TRUTH,
    error_m,
    matcher_command,
    street_map,
    street_scan,
)


def answer_of(stack: Any, client: Any, request: Any) -> Any:
    answer = client.call_async(request)
    spin_until(stack.node, answer.done)
    return answer.result()


def answer_during_scans(stack: Any, client: Any, request: Any) -> Any:
    """Return an answer during whose search more scans than the one under way got their poses.

    A search that ends while the test gets no CPU shows nothing: repeat it.
    """
    deadline = time.monotonic() + TIMEOUT_S
    while True:
        stack.poses.clear()
        answer = client.call_async(request)
        while not answer.done():
            stack.report_of(stack.send(street_scan(), NEAR))
        if len(stack.poses) > 2:
            return answer.result()
        assert time.monotonic() < deadline, "no scan was matched during a search"


def test_activation_and_initial_pose(stack, start):
    """Deactivated it gives no pose; ndt_align_srv finds the pose from metres away, at any yaw."""
    start(matcher_command(activated="false"), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    report = stack.report_of(stack.send(street_scan()))
    assert "not activated" in report.message
    align = stack.node.create_client(AlignService, "ndt_align_srv")
    shown = []
    stack.node.create_subscription(MarkerArray, "monte_carlo_initial_pose_marker", shown.append, 10)
    assert align.wait_for_service(TIMEOUT_S)
    rough = from_xyz_rpy((TRUTH[0, 3] + 1.5, TRUTH[1, 3] - 1.0, TRUTH[2, 3]), (0.0, 0.0, 2.5))
    spread = np.diag([1.0, 1.0, 0.01, 0.0001, 0.0001, 0.2])
    request = AlignService.Request(
        pose_with_covariance=pose_with_covariance(rough, spread, stack.stamp(), "map")
    )
    answer = align.call_async(request)
    spin_until(stack.node, answer.done)
    assert answer.result().success
    assert answer.result().reliable
    spin_until(stack.node, lambda: shown)
    assert len(shown[0].markers) == 1 + 200  # the first marker deletes the previous ones
    assert error_m(matrix_of(answer.result().pose_with_covariance.pose.pose)) < 0.1

    trigger = stack.node.create_client(SetBool, "trigger_node_srv")
    assert trigger.wait_for_service(TIMEOUT_S)
    answer = trigger.call_async(SetBool.Request(data=True))
    spin_until(stack.node, answer.done)
    assert error_m(stack.pose_of(street_scan(), NEAR)) < 0.1

    request.pose_with_covariance.header.frame_id = "nowhere"
    answer = align.call_async(request)
    spin_until(stack.node, answer.done)
    assert not answer.result().success


def test_without_a_guess_the_map_is_searched(stack, start):
    """The place of a scan is found wherever it is; a scan of another place is refused."""
    start(matcher_command(), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan(), NEAR)
    align = stack.node.create_client(AlignService, "ndt_align_srv")
    assert align.wait_for_service(TIMEOUT_S)
    anywhere = np.diag([1e6, 1e6, 0.01, 0.0001, 0.0001, 10.0])
    nowhere = from_xyz_rpy((-50.0, 70.0, 0.0), (0.0, 0.0, 2.0))
    request = AlignService.Request(
        pose_with_covariance=pose_with_covariance(nowhere, anywhere, stack.stamp(), "map")
    )
    answer = answer_of(stack, align, request)
    assert answer.success
    assert answer.reliable
    assert error_m(matrix_of(answer.pose_with_covariance.pose.pose)) < 0.1

    stack.report_of(stack.send(street_scan()[:, [2, 0, 1]], NEAR))  # walls for ground
    assert not answer_of(stack, align, request).success


def test_scans_are_matched_while_a_pose_is_searched(stack, start):
    """Autoware's service type of 2024 and before gives the same pose, and delays no scan."""
    few_guesses = {
        "initial_pose_estimation__particles_num": 40,
        "initial_pose_estimation__n_startup_trials": 20,
    }
    start(matcher_command(**few_guesses), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan(), NEAR)
    rough = pose_with_covariance(NEAR, COVARIANCE, stack.stamp(), "map")
    today = stack.node.create_client(AlignService, "ndt_align_srv")
    old = stack.node.create_client(Tier4AlignService, "ndt_align_tier4_srv")
    assert today.wait_for_service(TIMEOUT_S)
    assert old.wait_for_service(TIMEOUT_S)
    found = answer_of(stack, today, AlignService.Request(pose_with_covariance=rough))
    request = Tier4AlignService.Request(pose_with_covariance=rough)
    answer = answer_during_scans(stack, old, request)
    assert all(error_m(T) < 0.1 for T in stack.poses.values())
    assert answer.pose_with_covariance == found.pose_with_covariance
