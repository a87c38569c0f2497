# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Names: namespaces, remapping, private topics, domains; and the log topic."""

from __future__ import annotations

import os

import pytest
import rclpy
from rcl_interfaces.msg import Log
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from rmw_manycore_py.ros.domain import default_platform
from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node, spin_until
from support.peers.programs import forked_example
from support.processes.platforms import PLATFORMS

needs_manycore = pytest.mark.skipif(not IS_MANYCORE, reason="about what only DDS has")


def test_namespace_and_remapping(node, start, peer_cluster):
    heard = []
    node.create_subscription(String, "/far/away", heard.append, 10)
    remap = [
        "--ros-args",
        "-r",
        "__ns:=/robot",
        "-r",
        "__node:=speaker",
        "-r",
        "chatter:=/far/away",
    ]
    start(forked_example("talker", *remap, "-p", "rate_hz:=50.0"), peer_cluster)
    spin_until(node, lambda: heard)
    spin_until(node, lambda: ("speaker", "/robot") in node.get_node_names_and_namespaces())


def test_relative_and_private_names(node, start_peer, peer_cluster):
    heard = []
    node.create_subscription(String, "/robot/chatter", lambda m: heard.append(m.data), 10)
    node.create_subscription(String, "/robot/peer/own", lambda m: heard.append(m.data), 10)
    start_peer(publish_two, cluster=peer_cluster)
    spin_until(node, lambda: {"relative", "private"} <= set(heard))


def publish_two() -> None:
    with peer_node("peer", namespace="robot") as node:
        relative = node.create_publisher(String, "chatter", 10)
        private = node.create_publisher(String, "~/own", 10)
        node.create_timer(0.02, lambda: relative.publish(String(data="relative")))
        node.create_timer(0.02, lambda: private.publish(String(data="private")))
        rclpy.spin(node)


def test_long_names(node):
    topic = "/" + "/".join(["level"] * 40)
    received = []
    publisher = node.create_publisher(String, topic, 10)
    node.create_subscription(String, topic, received.append, 10)
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(String())
    spin_until(node, lambda: received)
    assert topic in dict(node.get_topic_names_and_types())


def test_log_topic(node, start_peer, peer_cluster):
    logs = []
    qos = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Log, "/rosout", logs.append, qos)
    peer = start_peer(log_one_line, cluster=peer_cluster)
    peer.wait_for("something happened")
    spin_until(node, lambda: any(log.msg == "something happened" for log in logs))
    (log,) = [log for log in logs if log.msg == "something happened"]
    assert (log.name, log.level, log.function) == ("peer", 30, "log_one_line")


def log_one_line() -> None:
    with peer_node() as node:
        node.get_logger().warning("something happened")
        rclpy.spin(node)


@pytest.mark.parametrize("same", [True, False], ids=["one_domain", "two_domains"])
def test_domains_are_apart(domains, start_peer, monkeypatch, same):
    """Without MANYCORE_PLATFORM the ROS domain determines the platform."""
    monkeypatch.delenv("MANYCORE_PLATFORM", raising=False)
    rclpy.init(domain_id=domains[0])
    node = rclpy.create_node("tester")
    heard = []
    node.create_subscription(String, "chatter", heard.append, 10)
    peer = start_peer(talk_in_domain, domains[0] if same else domains[1])
    peer.wait_for("published")
    if same:
        spin_until(node, lambda: heard)
        spin_until(node, lambda: sorted(node.get_node_names()) == ["peer", "tester"])
    else:
        rclpy.spin_once(node, timeout_sec=0.1)
        assert heard == []
        assert node.get_node_names() == ["tester"]
    node.destroy_node()
    rclpy.shutdown()


def test_a_context_of_another_domain_is_not_on_the_named_platform(node, domains, start_peer):
    """MANYCORE_PLATFORM, which `manycore run` sets, stands for the domain of the run."""
    heard = {"own": [], "other": []}
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domains[0])
    other = rclpy.create_node("other", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(other)
    node.create_subscription(String, "chatter", heard["own"].append, 10)
    other.create_subscription(String, "chatter", heard["other"].append, 10)
    publisher = node.create_publisher(String, "chatter", 10)
    start_peer(talk_to_itself).wait_for("published")
    spin_until(node, lambda: heard["own"])
    executor.spin_once(timeout_sec=0.1)
    assert heard["other"] == []
    assert publisher.get_subscription_count() == 2
    assert sorted(node.get_node_names()) == ["peer", "tester"]
    assert other.get_node_names() == ["other"]
    start_peer(talk_in_domain, domains[0]).wait_for("published")
    while not heard["other"]:
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    other.destroy_node()
    rclpy.shutdown(context=context)


@needs_manycore
@pytest.mark.parametrize("start", ["", " ", "+"], ids=ascii)
@pytest.mark.parametrize("number", ["7", "010", "0x5", "0X1f", "7x", "00"])
def test_python_reads_the_domain_as_rcl_and_the_middleware_do(monkeypatch, start, number):
    """Otherwise a program looks for its platform where the middleware is not."""
    monkeypatch.setenv("ROS_DOMAIN_ID", start + number)
    named = os.environ["MANYCORE_PLATFORM"]
    context = rclpy.Context()
    rclpy.init(context=context)
    domain = context.get_domain_id()
    assert (PLATFORMS / named).exists()
    rclpy.shutdown(context=context)
    assert default_platform(domain) == named
    monkeypatch.delenv("MANYCORE_PLATFORM")
    assert default_platform() == f"domain-{domain}"


@needs_manycore
def test_a_context_beside_the_named_platform_is_announced(domains, start_peer):
    """A program that chooses its domain would otherwise not find the nodes of its platform."""
    own, other = domains
    peer = start_peer(open_contexts, own, other, ROS_DOMAIN_ID=str(own))
    peer.wait_for("opened")
    (warning,) = [line for line in peer.output.splitlines() if "MANYCORE_PLATFORM" in line]
    assert f"is the platform of domain {own}" in warning
    assert f"joins platform domain-{other}" in warning


def open_contexts(*domains: int) -> None:
    for domain in domains:
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain)
        rclpy.shutdown(context=context)
    announce("opened")


def talk_in_domain(domain: int) -> None:
    """Publish to a reader of the own domain, to show that messages arrive at all."""
    os.environ.pop("MANYCORE_PLATFORM", None)
    os.environ["ROS_DOMAIN_ID"] = str(domain)
    talk_to_itself()


def talk_to_itself() -> None:
    with peer_node() as node:
        heard = []
        publisher = node.create_publisher(String, "chatter", 10)
        node.create_subscription(String, "chatter", heard.append, 10)
        node.create_timer(0.02, lambda: publisher.publish(String()))
        spin_until(node, lambda: len(heard) > 2)
        announce("published")
        rclpy.spin(node)


@needs_manycore
@pytest.mark.parametrize("name", ["LOCALHOST", "SUBNET", "SYSTEM_DEFAULT"])
def test_discovery_ranges_that_include_this_machine(node, start_peer, name):
    heard = []
    node.create_subscription(String, "chatter", heard.append, 10)
    start_peer(talk_to_itself, ROS_AUTOMATIC_DISCOVERY_RANGE=name)
    spin_until(node, lambda: heard)


def test_the_discovery_range_off_keeps_a_process_alone(node, start_peer):
    heard = []
    node.create_subscription(String, "chatter", heard.append, 10)
    peer = start_peer(talk_to_itself, ROS_AUTOMATIC_DISCOVERY_RANGE="OFF")
    peer.wait_for("published")
    rclpy.spin_once(node, timeout_sec=0.1)
    assert heard == []
    assert node.get_node_names() == ["tester"]


@needs_manycore
def test_static_peers_are_ignored_with_a_warning(node, start_peer):
    peer = start_peer(talk_to_itself, ROS_STATIC_PEERS="192.168.0.1")
    peer.wait_for("static discovery peers are ignored")
    peer.wait_for("published")


@needs_manycore
def test_security_that_must_be_enforced_is_refused(start_peer, tmp_path):
    """A node must not run unprotected because its middleware lacks DDS security."""
    (tmp_path / "enclaves").mkdir()
    security = {
        "ROS_SECURITY_ENABLE": "true",
        "ROS_SECURITY_STRATEGY": "Enforce",
        "ROS_SECURITY_KEYSTORE": str(tmp_path),
    }
    peer = start_peer(talk_to_itself, **security)
    peer.wait_for("rmw_manycore does not support DDS security")
    assert peer.wait() != 0
