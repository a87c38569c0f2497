# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages filled from YAML, with messages of the real packages."""

from __future__ import annotations

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, PoseWithCovariance
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Bool, Byte, ByteMultiArray, Float64, Int32, String, UInt8MultiArray
from test_msgs.action import Fibonacci

from rmw_manycore_py.cli.common.message_values import message_of, parse_values
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

pytestmark = pytest.mark.unit

STAMP = Time(sec=7, nanosec=8)


def filled(message_type, text: str):
    return message_of(message_type, parse_values(text), STAMP)


@pytest.mark.parametrize(
    ("message_type", "text", "expected"),
    [
        (String, "data: hello", String(data="hello")),
        (String, "{data: 5}", String(data="5")),
        (String, "", String()),
        (Float64, "data: 2", Float64(data=2.0)),
        (Float64, "data: .inf", Float64(data=float("inf"))),
        (Bool, "data: true", Bool(data=True)),
        (Byte, "data: 200", Byte(data=b"\xc8")),
        (ByteMultiArray, "data: [1, 2]", ByteMultiArray(data=[b"\x01", b"\x02"])),
        (UInt8MultiArray, "data: [1, 255]", UInt8MultiArray(data=[1, 255])),
        (Fibonacci.Goal, "order: 10", Fibonacci.Goal(order=10)),
    ],
)
def test_scalars_and_arrays(message_type, text: str, expected) -> None:
    assert filled(message_type, text) == expected


def test_nested_messages() -> None:
    pose = filled(PoseStamped, "{header: {frame_id: map}, pose: {position: {x: 1, y: 2}}}")
    assert (pose.header.frame_id, pose.pose.position.x, pose.pose.position.y) == ("map", 1.0, 2.0)
    assert pose.pose.orientation.w == 1.0
    cloud = filled(PointCloud2, "fields: [{name: x, datatype: 7}, {name: y, offset: 4}]")
    assert [(f.name, f.offset, f.datatype) for f in cloud.fields] == [("x", 0, 7), ("y", 4, 0)]
    covariance = filled(PoseWithCovariance, f"covariance: {list(range(36))}").covariance
    assert covariance[35] == 35.0


def test_words_for_the_present_time() -> None:
    assert filled(PoseStamped, "header: auto").header.stamp == STAMP
    assert filled(PoseStamped, "header: {stamp: now}").header.stamp == STAMP


@pytest.mark.parametrize(
    ("message_type", "text", "expected"),
    [
        (String, "x: y", "no field 'x'; there is data"),
        (String, "dat: x", "Failed to populate field: no field 'dat'; did you mean 'data'"),
        (String, "data: [x]", r"data: expected string, found \['x'\]"),
        (Int32, "data: many", "data: expected int32, found 'many'"),
        (Int32, "data: true", "data: expected int32, found True"),
        (Int32, f"data: {1 << 40}", "data: expected int32"),
        (Bool, "data: 1", "data: expected boolean, found 1"),
        (Byte, "data: 256", "data: expected octet, found 256"),
        (PoseStamped, "pose: {position: {x: here}}", "pose.position.x: expected double"),
        (PoseStamped, "pose: 5", "pose.: expected the fields of a Pose"),
        (PointCloud2, "fields: {name: x}", "fields: expected sequence<sensor_msgs/PointField>"),
        (PoseWithCovariance, "covariance: [1, 2]", r"covariance: expected double\[36\]"),
        (String, "hello", "expected fields like"),
        (String, "data: [", "not YAML"),
        (String, "data: 2024-13-01", "not YAML: values:1: data: expected a date"),
    ],
)
def test_what_does_not_fit_is_an_error(message_type, text: str, expected: str) -> None:
    with pytest.raises(ManycoreError, match=expected) as caught:
        filled(message_type, text)
    assert caught.value.exit_status == EXIT_BAD_INPUT
