# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How the tools present the rows of a platform."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rmw_manycore_py.cli.common import view

pytestmark = pytest.mark.unit

COUNTERS = {
    "messages": 9,
    "bytes": 90,
    "lost": 0,
    "superseded": 0,
    "expired": 0,
    "refused": 0,
    "overwritten": 0,
    "dropped": 0,
    "in_place": 0,
}


def endpoint(node: str, kind: str, role: str, topic: str, type_name: str, **counters: int) -> Any:
    namespace, _, name = node.rpartition("/")
    return SimpleNamespace(
        kind=kind,
        role=role,
        topic=topic,
        type=type_name,
        node_name=name,
        node_namespace=namespace or "/",
        counters=SimpleNamespace(**{**COUNTERS, **counters}),
    )


ENDPOINTS = [
    endpoint("/talker", "publisher", "topic", "/chatter", "std_msgs/msg/String"),
    endpoint("/a/listener", "subscription", "topic", "/chatter", "std_msgs/msg/String"),
    endpoint("/a/listener", "subscription", "topic", "/chatter", "std_msgs/msg/Int32"),
    endpoint("/talker", "publisher", "topic", "/count/_action/status", "x/msg/Status"),
    endpoint("/talker", "subscription", "request", "/add", "x/srv/Add"),
    endpoint("/talker", "publisher", "reply", "/add", "x/srv/Add"),
    endpoint("/a/listener", "publisher", "request", "/add", "x/srv/Add"),
    endpoint("/a/listener", "subscription", "reply", "/add", "x/srv/Add"),
    endpoint(
        "/talker", "subscription", "request", "/count/_action/send_goal", "x/action/Count_SendGoal"
    ),
]


def test_topics_are_sorted_and_hidden_ones_left_out() -> None:
    assert view.topics(ENDPOINTS) == [
        {
            "name": "/chatter",
            "types": ["std_msgs/msg/String", "std_msgs/msg/Int32"],
            "publishers": 1,
            "subscriptions": 2,
        }
    ]
    names = [row["name"] for row in view.topics(ENDPOINTS, hidden=True)]
    assert names == ["/chatter", "/count/_action/status"]


def test_services_and_actions_of_a_node() -> None:
    talker = view.node_interfaces(ENDPOINTS, "/talker")
    assert talker["publishers"] == {"/chatter": "std_msgs/msg/String"}
    assert talker["service_servers"] == {"/add": "x/srv/Add"}
    assert talker["action_servers"] == {"/count": "x/action/Count"}
    listener = view.node_interfaces(ENDPOINTS, "/a/listener")
    assert listener["service_clients"] == {"/add": "x/srv/Add"}
    assert listener["service_servers"] == {}


def test_the_parts_of_an_action_are_shown_when_asked_for() -> None:
    shown = view.node_interfaces(ENDPOINTS, "/talker", hidden=True)
    assert "/count/_action/send_goal" in shown["service_servers"]
    assert "/count/_action/status" in shown["publishers"]


def test_nodes_come_with_their_place() -> None:
    nodes = [
        SimpleNamespace(name="talker", namespace="/", process=1),
        SimpleNamespace(name="_hidden", namespace="/", process=0),
    ]
    processes = [SimpleNamespace(slot=1, cluster=2, core=None, host_cpu=None, pid=42)]
    names = view.node_names(nodes)
    assert names == ["/talker"]
    place = {"cluster": 2, "core": None, "host_cpu": None, "pid": 42}
    assert view.placed_nodes(nodes, processes, set(names)) == [{"node": "/talker", **place}]


def test_only_losses_are_reported() -> None:
    lossy = endpoint("/a/b", "subscription", "topic", "/t", "x/msg/X", lost=3, superseded=2)
    assert view.losses([*ENDPOINTS, lossy]) == [
        {"node": "/a/b", "topic": "/t", "counter": "lost", "count": 3}
    ]
    assert view.superseded([*ENDPOINTS, lossy]) == [{"node": "/a/b", "topic": "/t", "count": 2}]
