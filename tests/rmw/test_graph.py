# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Graph queries: nodes and their topics, types, type hashes and QoS."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
import rclpy
from rclpy.duration import Duration, Infinite
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointTypeEnum
from std_msgs.msg import String, UInt8MultiArray
from std_srvs.srv import Trigger

from support.nodes.ros import peer_node, spin_until
from support.peers.programs import forked_example

QOS = QoSProfile(
    depth=7,
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    lifespan=Duration(seconds=2),
)


def be_there() -> None:
    with peer_node("peer", namespace="/far") as node:
        node.create_publisher(String, "chatter", QOS)
        node.create_subscription(UInt8MultiArray, "data", lambda _: None, 10)
        node.create_service(Trigger, "serve", lambda _, response: response)
        node.create_client(Trigger, "/ask")
        rclpy.spin(node)


@pytest.fixture
def peer(node, start_peer, peer_cluster):
    """Start a node with one endpoint of each kind and wait until it is discovered."""
    program = start_peer(be_there, cluster=peer_cluster)
    spin_until(node, lambda: ("peer", "/far") in node.get_node_names_and_namespaces())
    spin_until(node, lambda: dict(node.get_client_names_and_types_by_node("peer", "/far")))
    return program


def type_hash(message: str) -> str:
    """Return the hash in the message's own package, for example "RIHS01_df66..."."""
    package, _, name = message.split("/")
    description = Path(sys.prefix, "share", package, "msg", f"{name}.json")
    hashes = json.loads(description.read_text())["type_hashes"]
    return next(entry["hash_string"] for entry in hashes if entry["type_name"] == message)


def services_of(node: Node) -> list[str]:
    return [name for name, _ in node.get_service_names_and_types()]


def test_node_names(node, peer):
    assert sorted(node.get_node_names_and_namespaces()) == [("peer", "/far"), ("tester", "/")]
    names = node.get_node_names_and_namespaces_with_enclaves()
    assert ("peer", "/far", "/") in names


def test_enclaves(node, start, peer_cluster):
    start(forked_example("talker", "--ros-args", "--enclave", "/robot/arm"), peer_cluster)
    talker = ("talker", "/", "/robot/arm")
    spin_until(node, lambda: talker in node.get_node_names_and_namespaces_with_enclaves())


def test_topics_and_types(node, peer):
    topics = dict(node.get_topic_names_and_types())
    assert topics["/far/chatter"] == ["std_msgs/msg/String"]
    assert topics["/far/data"] == ["std_msgs/msg/UInt8MultiArray"]
    assert topics["/rosout"] == ["rcl_interfaces/msg/Log"]
    assert not [topic for topic in topics if "serve" in topic]


def test_services_and_types(node, peer):
    services = dict(node.get_service_names_and_types())
    assert services["/far/serve"] == ["std_srvs/srv/Trigger"]
    assert services["/far/peer/get_parameters"] == ["rcl_interfaces/srv/GetParameters"]


def test_by_node(node, peer):
    publishers = dict(node.get_publisher_names_and_types_by_node("peer", "/far"))
    subscriptions = dict(node.get_subscriber_names_and_types_by_node("peer", "/far"))
    services = dict(node.get_service_names_and_types_by_node("peer", "/far"))
    clients = dict(node.get_client_names_and_types_by_node("peer", "/far"))
    assert publishers["/far/chatter"] == ["std_msgs/msg/String"]
    assert subscriptions == {"/far/data": ["std_msgs/msg/UInt8MultiArray"]}
    assert services["/far/serve"] == ["std_srvs/srv/Trigger"]
    assert clients == {"/ask": ["std_srvs/srv/Trigger"]}


def test_unknown_node(node):
    with pytest.raises(rclpy.node.NodeNameNonExistentError):
        node.get_publisher_names_and_types_by_node("none", "/")


def test_counts(node, peer):
    assert node.count_publishers("/far/chatter") == 1
    assert node.count_subscribers("/far/chatter") == 0
    assert node.count_subscribers("/far/data") == 1
    assert node.count_services("/far/serve") == 1
    assert node.count_clients("/ask") == 1
    assert node.count_clients("/far/serve") == 0


def test_endpoint_info(node, peer):
    (info,) = node.get_publishers_info_by_topic("/far/chatter")
    assert (info.node_name, info.node_namespace) == ("peer", "/far")
    assert info.topic_type == "std_msgs/msg/String"
    assert str(info.topic_type_hash) == type_hash("std_msgs/msg/String")
    assert info.endpoint_type == TopicEndpointTypeEnum.PUBLISHER
    assert any(info.endpoint_gid)
    (other,) = node.get_subscriptions_info_by_topic("/far/data")
    assert other.endpoint_type == TopicEndpointTypeEnum.SUBSCRIPTION
    assert other.endpoint_gid != info.endpoint_gid
    assert str(other.topic_type_hash) == type_hash("std_msgs/msg/UInt8MultiArray")


def test_endpoint_qos(node, peer):
    qos = node.get_publishers_info_by_topic("/far/chatter")[0].qos_profile
    assert qos.reliability == ReliabilityPolicy.BEST_EFFORT
    assert qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert qos.lifespan == Duration(seconds=2)
    assert qos.deadline == Infinite
    # Other middlewares may not report history and depth: DDS does not transmit them.
    assert qos.history in (HistoryPolicy.KEEP_LAST, HistoryPolicy.UNKNOWN)


@pytest.mark.parametrize("how", ["stop", "kill"])
def test_a_node_that_ends_leaves_the_graph(node, peer, how):
    getattr(peer, how)()

    def is_gone() -> bool:  # endpoints and node names are read one after the other
        names, publishers = node.get_node_names(), node.count_publishers("/far/chatter")
        return (names, publishers, node.count_services("/far/serve")) == (["tester"], 0, 0)

    spin_until(node, is_gone)


def be_there_briefly() -> None:
    """Leave the service get_type_description behind, which rclpy never destroys."""
    rclpy.init()
    rclpy.create_node("brief").destroy_node()
    rclpy.shutdown()


def test_what_a_process_did_not_destroy_leaves_the_graph(node, start_peer, peer_cluster):
    start_peer(be_there_briefly, cluster=peer_cluster).wait()
    spin_until(node, lambda: not any("brief" in name for name in services_of(node)))


def test_endpoints_come_and_go(node):
    publisher = node.create_publisher(String, "chatter", 10)
    subscription = node.create_subscription(String, "chatter", lambda _: None, 10)
    spin_until(node, lambda: publisher.get_subscription_count() == 1)
    assert node.count_publishers("chatter") == 1
    node.destroy_subscription(subscription)
    spin_until(node, lambda: publisher.get_subscription_count() == 0)
    node.destroy_publisher(publisher)
    spin_until(node, lambda: node.count_publishers("chatter") == 0)


def test_nodes_of_one_process(node):
    """Several nodes of a process are distinguished."""
    others = [rclpy.create_node(f"other_{n}", namespace="/ns") for n in range(3)]
    wanted = [("other_0", "/ns"), ("other_1", "/ns"), ("other_2", "/ns"), ("tester", "/")]
    spin_until(node, lambda: sorted(node.get_node_names_and_namespaces()) == wanted)
    others[0].create_publisher(String, "chatter", 10)
    spin_until(node, lambda: node.get_publishers_info_by_topic("/ns/chatter"))
    assert node.get_publishers_info_by_topic("/ns/chatter")[0].node_name == "other_0"
    for other in others:
        other.destroy_node()
    spin_until(node, lambda: node.get_node_names() == ["tester"])
