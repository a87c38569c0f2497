# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fixtures of the tests that use rclpy in their own process."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.node import Node

from support import IS_MANYCORE, wait_until
from support.nodes.ros import announce
from support.nodes.scan_matching import Stack, matcher_command, street_map
from support.processes.commands import peer_command
from support.processes.domains import domain_of
from support.processes.platforms import leftovers
from support.processes.program import Program


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    here = f"{Path(__file__).parent}/"
    for item in items:
        if str(item.path).startswith(here):
            item.add_marker("rmw")


@pytest.fixture
def node() -> Iterator[Node]:
    """Yield a node of this process, in cluster 1."""
    rclpy.init()
    node = rclpy.create_node("tester")
    yield node
    node.destroy_node()
    rclpy.shutdown()


@pytest.fixture
def start_peer(start: Callable[..., Program]) -> Callable[..., Program]:
    """Return a function that runs a function of the test file in a new process."""

    def start_peer(
        function: Callable[..., None], *arguments: Any, cluster: int = 1, **env: str
    ) -> Program:
        return start(peer_command(function, *arguments), cluster, **env)

    return start_peer


@pytest.fixture
def domains() -> Iterator[tuple[int, int]]:
    """Yield two ROS domains for this test alone; afterwards check that nothing of them is left.

    Request it before programs are started in them, so that those end first.
    """
    domains = domain_of("first"), domain_of("second")
    yield domains
    if IS_MANYCORE:
        for name in (f"domain-{domain}" for domain in domains):
            wait_until(lambda name=name: not leftovers(name), f"{name} leaves nothing")


@pytest.fixture
def small_topic(start_peer: Callable[..., Program]) -> Iterator[str]:
    """Yield a topic or service with little memory, on a platform that rclpy has joined."""
    topic = "/small"
    start_peer(configure, topic).wait_for("configured")
    rclpy.init()
    yield topic
    rclpy.shutdown()


def configure(topic: str) -> None:
    """Configure a platform, in another process: rclpy's library would not see it in this one."""
    from rmw_manycore_py.native import _transport

    small = _transport.TopicConfiguration(topic, id=1, dsm_size_bytes=8192, receiver_clusters=0)
    with _transport.Configurator(
        os.environ["MANYCORE_PLATFORM"],
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=0,
        host_cpu_of_receive_thread={},
        topics=[small],
    ):
        announce("configured")
        sys.stdin.read()


@pytest.fixture(params=[1, 2], ids=["same_cluster", "other_cluster"])
def peer_cluster(request: pytest.FixtureRequest) -> int:
    """Return the cluster of the peer: the test's own or another one."""
    return int(request.param)


@pytest.fixture
def stack(node: Node) -> Stack:
    """Return the rest of a stack around a scan matcher."""
    return Stack(node)


@pytest.fixture
def matched(stack: Stack, start: Callable[..., Program]) -> Stack:
    """Return a stack whose matcher runs in cluster 2 and has the map."""
    start(matcher_command(), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    return stack
