# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Guesses of `ndt_scan_matcher`: each scan is matched from its own guess, or from none."""

from __future__ import annotations

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.messages.conversions import (
    matrix_of,
    nanoseconds,
    pose_with_covariance,
    stamp_of,
)
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.nodes.scan_matcher.guesses import PERIODS
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


def value_of(report: DiagnosticStatus, key: str) -> str:
    return {pair.key: pair.value for pair in report.values}[key]


def test_no_scan_is_matched_from_the_guess_of_another(stack, start):
    """Scans and guesses arrive at once, the scans first, each guess 3 m from the next.

    The newest scan is matched from its own guess; each other one is answered or reported as
    skipped.
    """
    start(matcher_command(validation__initial_pose_wait_sec=TIMEOUT_S / 10), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan())
    first = []
    stack.node.create_subscription(
        PoseWithCovarianceStamped, "initial_pose_with_covariance", first.append, 10
    )
    now_ns = nanoseconds(stack.stamp())
    stamps_ns = [now_ns + index * 100_000_000 for index in range(4)]
    for stamp_ns in stamps_ns:
        stack.scans.publish(encode(street_scan(), stamp_of(stamp_ns), "base_link"))
    for index, stamp_ns in enumerate(stamps_ns):
        guess = TRUTH @ from_xyz_rpy((3.0 * (len(stamps_ns) - 1 - index), 0.0, 0.0))
        stamp = stamp_of(stamp_ns)
        stack.guesses.publish(pose_with_covariance(guess, COVARIANCE, stamp, "map"))
    reports = [stack.report_of(stamp_ns) for stamp_ns in stamps_ns]
    assert "skipped" not in reports[-1].message
    spin_until(stack.node, lambda: stamps_ns[-1] in stack.poses)
    assert error_m(stack.poses[stamps_ns[-1]]) < 0.1
    skipped = sum("skipped: a newer scan" in report.message for report in reports)
    assert value_of(reports[-1], "skipped_scans") == str(skipped)
    spin_until(
        stack.node, lambda: nanoseconds(first[-1].header.stamp) == stamps_ns[-1] if first else False
    )
    for message in first:
        index = stamps_ns.index(nanoseconds(message.header.stamp))
        expected_m = 3.0 * (len(stamps_ns) - 1 - index)
        assert error_m(matrix_of(message.pose.pose)) == pytest.approx(expected_m, abs=0.01)


def test_a_guess_too_old_for_a_scan_is_refused(matched):
    matched.pose_of(street_scan())
    now_ns = nanoseconds(matched.stamp())
    for number in range(PERIODS):  # a period of ten milliseconds, however long matching takes
        stamp_ns = now_ns + number * 10_000_000
        matched.report_of(matched.send(street_scan(), stamp=stamp_of(stamp_ns)))
    ahead_ns = stamp_ns + 900_000_000
    matched.scans.publish(encode(street_scan(), stamp_of(ahead_ns), "base_link"))
    report = matched.report_of(ahead_ns)
    assert "Couldn't interpolate pose: the newest pose is" in report.message
    assert ahead_ns not in matched.poses
    assert error_m(matched.pose_of(street_scan(), NEAR)) < 0.1


def test_as_in_autoware_a_guess_holds_for_a_second(stack, start):
    start(matcher_command(behaviour="autoware"), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan())
    stack.report_of(stamp_ns := stack.send(street_scan()))
    ahead_ns = stamp_ns + 500_000_000
    stack.scans.publish(encode(street_scan(), stamp_of(ahead_ns), "base_link"))
    spin_until(stack.node, lambda: ahead_ns in stack.poses)
    assert error_m(stack.poses[ahead_ns]) < 0.1
