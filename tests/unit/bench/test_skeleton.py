# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The skeleton of a profile has its nodes' endpoints, with rates and sizes."""

from __future__ import annotations

from typing import Any

import pytest

from rmw_manycore_py.bench.scale.sizes import OTHER_BYTES, assumed_bytes
from rmw_manycore_py.bench.scale.skeleton import Input, Node, Output, skeleton_of
from rmw_manycore_py.profile.model import Profile, Publisher, Subscription
from support.samples.profiles import MS, pipeline, steady

pytestmark = pytest.mark.unit


def publisher(topic: str, **fields: Any) -> Publisher:
    values: dict[str, Any] = {
        "node": 0, "topic": topic, "queue_depth": 3, "publications": None,
        "outside_callbacks": None, "interval_ns": None, "size_bytes": None,
    }  # fmt: skip
    return Publisher(**{**values, **fields})


def outputs(*publishers: Publisher, **fields: Any) -> tuple[Output, ...]:
    profile: Profile = pipeline(publishers=publishers, **fields)
    return skeleton_of(profile).nodes[0].outputs


def test_a_skeleton_has_the_endpoints_of_the_profile() -> None:
    assert skeleton_of(pipeline()).nodes == (
        Node("/camera", (Output("/image", 10, 1000, 10.0),), ()),
        Node("/filter", (Output("/small", 10, 1000, 10.0),), (Input("/image", 2),)),
        Node("/sink", (), (Input("/small", 2),)),
    )


def test_what_every_node_has_is_left_out() -> None:
    events = Subscription(node=0, topic="/parameter_events", queue_depth=1000)
    skeleton = skeleton_of(pipeline(subscriptions=(events,)))
    assert skeleton.nodes[0].inputs == ()
    assert outputs(publisher("/rosout"), publisher("/parameter_events")) == ()


def test_the_rate_is_of_counts_or_else_of_intervals() -> None:
    counted = publisher("/a", publications=5, interval_ns=steady(1 * MS))
    regular = publisher("/b", interval_ns=steady(50 * MS))
    assert [one.rate_hz for one in outputs(counted, regular)] == [0.5, 20.0]
    assert [one.rate_hz for one in outputs(counted, duration_ns=None)] == [1000.0]
    assert outputs(publisher("/silent"))[0].rate_hz == 0


def test_a_message_is_delivered_to_each_subscription_of_its_topic() -> None:
    both = tuple(Subscription(node=node, topic="/image", queue_depth=1) for node in (1, 2))
    skeleton = skeleton_of(pipeline(subscriptions=both))
    assert (skeleton.rate_hz, skeleton.deliveries_hz) == (20, 20)
    assert skeleton.first(2).deliveries_hz == 10
    assert skeleton.first(1).deliveries_hz == 0


def test_sizes_are_assumed_where_the_profile_has_none() -> None:
    known, cloud = outputs(publisher("/points", size_bytes=steady(7)), publisher("/points"))
    assert (known.size_bytes, cloud.size_bytes) == (7, assumed_bytes("/lidar/points"))
    assert assumed_bytes("/vehicle/velocity") == OTHER_BYTES


def test_nodes_wait_for_each_other_only_if_they_are_there() -> None:
    skeleton = skeleton_of(pipeline())
    camera, image_filter, sink = skeleton.arguments()
    assert camera["publishers"] == "/image:10:1000:100000:1"
    assert image_filter["subscriptions"] == "/image:2:1"
    assert sink["publishers"] == ""
    (alone,) = skeleton.first(1).arguments()
    assert alone["publishers"] == "/image:10:1000:100000:0"
