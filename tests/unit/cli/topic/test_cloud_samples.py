# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clouds and judgements as the page shows them."""

from __future__ import annotations

from base64 import b64decode
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from sensor_msgs.msg import Image, PointCloud2, PointField

from rmw_manycore_py.cli.topic.cloud_samples import (
    MAX_POINTS,
    MAX_TEXT,
    cloud_of,
    is_cloud,
    judgement_of,
)
from rmw_manycore_py.ndt.messages.point_cloud import encode

pytestmark = pytest.mark.unit


def cloud(points: Any) -> PointCloud2:
    message: PointCloud2 = encode(np.array(points, np.float64).reshape(-1, 3), Time(), "map")
    return message


def points_of(row: dict[str, Any]) -> np.ndarray:
    relative = np.frombuffer(b64decode(row["points"]), "<f4").reshape(-1, 3)
    return np.array(row["origin"]) + relative


def test_only_clouds_are_clouds() -> None:
    assert is_cloud(PointCloud2())
    assert not is_cloud(Image())


def test_points_are_sent_lowest_first() -> None:
    row = cloud_of(cloud([[1, 2, 3], [4, 5, -6], [7, 8, 0]]))
    assert (row["frame"], row["count"], row["shown"]) == ("map", 3, 3)
    np.testing.assert_allclose(points_of(row), [[4, 5, -6], [7, 8, 0], [1, 2, 3]])
    np.testing.assert_allclose(row["heights"], [-6, 3], atol=0.3)


def test_places_far_away_stay_exact() -> None:
    far = np.array([[500_000.25, 4_649_776.125, 40.0], [500_010.25, 4_649_786.125, 41.0]])
    np.testing.assert_allclose(points_of(cloud_of(cloud(far))), far, rtol=0, atol=1e-4)


def test_large_clouds_are_thinned() -> None:
    row = cloud_of(cloud(np.random.default_rng(1).random((3 * MAX_POINTS, 3))))
    assert (row["count"], row["shown"]) == (3 * MAX_POINTS, MAX_POINTS)
    assert len(points_of(row)) == MAX_POINTS


def test_points_without_position_are_left_out() -> None:
    row = cloud_of(cloud([[np.nan, 0, 0], [1, 2, 3], [0, np.inf, 0]]))
    assert (row["count"], row["shown"]) == (3, 1)
    np.testing.assert_allclose(points_of(row), [[1, 2, 3]])


def test_other_byte_orders_are_read() -> None:
    message = cloud([[1, 2, 3]])
    message.is_bigendian = True
    message.data = np.array([1, 2, 3], ">f4").tobytes()
    np.testing.assert_allclose(points_of(cloud_of(message)), [[1, 2, 3]])


def test_clouds_that_cannot_be_drawn_say_why() -> None:
    flat = cloud([[1, 2, 3]])
    flat.fields = [PointField(name="range", datatype=PointField.FLOAT32, count=1)]
    short = cloud([[1, 2, 3]])
    short.data = short.data[:-1]
    for message, problem in (
        (cloud([]), "the cloud is empty"),
        (cloud([[np.nan] * 3] * 2), "none of 2 points has a finite position"),
        (flat, "the cloud has no field 'x'; its fields: range"),
        (short, "1 x 1 points need 12 bytes of data, found 11"),
    ):
        row = cloud_of(message)
        assert row["problem"] == problem
        assert "points" not in row


@pytest.mark.parametrize(
    ("message", "values", "text", "believed"),
    [
        ("OK", {"is_activated": True, "skipping_publish_num": 0}, "believed", True),
        (
            "NDT exe time is too long (took 120.0 ms)",
            {"is_activated": True, "skipping_publish_num": 0},
            "believed, but NDT exe time is too long (took 120.0 ms)",
            True,
        ),
        (
            "the score is low",
            {"is_activated": True, "skipping_publish_num": 3},
            "refused: the score is low",
            False,
        ),
        (
            "Node is not activated",
            {"is_activated": False, "skipping_publish_num": 0},
            "refused: Node is not activated",
            False,
        ),
        ("the scan is empty", {"skipping_publish_num": 0}, "refused: the scan is empty", False),
        ("skipped: a newer one", {"skipped_scans": 1}, "skipped: a newer one", False),
    ],
)
def test_a_judgement_says_whether_and_why(
    message: str, values: dict[str, object], text: str, believed: bool
) -> None:
    pairs = [KeyValue(key=key, value=str(value)) for key, value in values.items()]
    found = judgement_of(DiagnosticStatus(message=message, values=pairs))
    assert found == {"text": text, "believed": believed}


def test_long_texts_are_cut() -> None:
    far = cloud([[1, 2, 3]])
    far.header.frame_id = "f" * (8 << 20)
    assert cloud_of(far)["frame"] == "f" * MAX_TEXT + "..."
    flat = cloud([[1, 2, 3]])
    flat.fields = [PointField(name="n" * (8 << 20), datatype=PointField.FLOAT32, count=1)]
    problem = cloud_of(flat)["problem"]
    assert problem.startswith("the cloud has no field 'x'; its fields: nnn")
    assert len(problem) == MAX_TEXT + len("...")
    active = [("is_activated", "True"), ("skipping_publish_num", "0")]
    for pairs in ([], active[1:], active):
        values = [KeyValue(key=key, value=value) for key, value in pairs]
        status = DiagnosticStatus(message="m" * (8 << 20), values=values)
        assert judgement_of(status)["text"].endswith("mm...")
        assert len(judgement_of(status)["text"]) < 2 * MAX_TEXT
