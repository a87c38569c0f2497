# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scans taken while the vehicle moved, with the times of their points."""

from __future__ import annotations

from typing import Any

import numpy as np
from builtin_interfaces.msg import Time

from rmw_manycore_py.ndt.messages.conversions import nanoseconds, pose_with_covariance
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.simulation.drive import Surroundings, poses_along
from rmw_manycore_py.ndt.simulation.street import build_street
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    COVARIANCE,
    LIDAR,
    TRUTH,
    error_m,
    matcher_command,
    street_map,
)

X_M, SPEED_M_S = 5.0, 20.0
OK = b"\x00"


def report_on(stack: Any, cloud: Any) -> tuple[int, Any]:
    """Publish a scan with the exact guesses of a drive; return its stamp and its diagnostics."""
    stamp = stack.stamp()
    stamp_ns = nanoseconds(stamp)
    for before_s in (0.2, 0.1, 0.0):
        T = poses_along([X_M - SPEED_M_S * before_s])[0]
        time_ns = stamp_ns - round(1e9 * before_s)
        at = Time(sec=time_ns // 10**9, nanosec=time_ns % 10**9)
        stack.guesses.publish(pose_with_covariance(T, COVARIANCE, at, "map"))
    cloud.header.stamp = stamp
    stack.scans.publish(cloud)
    return stamp_ns, stack.report_of(stamp_ns)


def values_of(report: Any) -> dict[str, str]:
    """Return the values of the diagnostics, by key."""
    return {one.key: one.value for one in report.values}


def test_motion_is_taken_out_where_the_points_have_times(stack, start):
    start(matcher_command(sensor_points__deskew="true"), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    street = build_street(10.0, np.random.default_rng(1))
    moving = Surroundings(street, LIDAR, speed_m_s=SPEED_M_S)
    sweep = moving.scan(TRUTH, X_M / SPEED_M_S, np.random.default_rng(2))
    plain = encode(sweep.points, Time(), "base_link")

    standing = Surroundings(street, LIDAR).scan(TRUTH, 0.0, np.random.default_rng(3)).points
    stack.pose_of(encode(standing, Time(), "base_link", {"time": np.zeros(len(standing))}))
    stack.begin_anew()  # the vehicle moves from here on

    timed = encode(sweep.points, Time(), "base_link", {"time": sweep.times_s})
    stamp_ns, report = report_on(stack, timed)
    assert values_of(report)["is_deskewed"] == "True"
    spin_until(stack.node, lambda: stamp_ns in stack.poses)
    assert error_m(stack.poses[stamp_ns]) < 0.05

    # Without deskewing it fits best half a metre off the exact guess.
    _, report = report_on(stack, plain)
    assert "not deskewed: the cloud has none of the fields time_stamp" in report.message
    assert float(values_of(report)["distance_initial_to_result"]) > 0.5

    slow = encode(sweep.points, Time(), "base_link", {"time": 60 * sweep.times_s})
    _, report = report_on(stack, slow)
    assert "not deskewed: the times of the points (time) span " in report.message
