# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Platforms inspected, configured and joined from Python without ROS."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from rmw_manycore_py.native._transport import (
    Configurator,
    EndpointInfo,
    Platform,
    Process,
    Qos,
    TopicConfiguration,
)
from support import wait_until
from support.processes.platforms import leftovers

pytestmark = pytest.mark.integration

STRING = "std_msgs/msg/String"
TYPE_HASH = "RIHS01_" + "0123456789abcdef" * 4
SMEM_BYTES = 8 << 20


@pytest.fixture
def configured(platform: str) -> Iterator[str]:
    with Configurator(
        platform,
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=SMEM_BYTES,
        host_cpu_of_receive_thread={},
        topics=[TopicConfiguration("/fixed", id=7, dsm_size_bytes=8192, receiver_clusters=0b10)],
    ):
        yield platform


def test_a_platform_is_what_was_configured(configured: str) -> None:
    with Platform(configured) as seen:
        info = seen.info()
        (topic,) = seen.topic_table()
        assert (seen.processes(), seen.nodes(), seen.endpoints()) == ([], [], [])
    assert (info.name, info.clusters, info.cores_per_cluster) == (configured, 2, 4)
    assert (info.smem_bytes, info.alive) == (SMEM_BYTES, True)
    assert (topic.name, topic.id, topic.dsm_size_bytes) == ("/fixed", 7, 8192)
    assert topic.receiver_clusters == 0b10


def test_what_a_member_shows_of_itself(configured: str) -> None:
    with Process(configured, cluster=2, label="member") as member, Platform(configured) as seen:
        qos = Qos(durability="transient_local", depth=3, deadline_ns=10**9)
        publisher = member.publisher("/t", STRING, qos, type_hash=TYPE_HASH)
        subscription = member.subscription("/t", STRING, Qos())
        publisher.publish(b"12345678")

        (process,) = seen.processes()
        assert (process.pid, process.cluster, process.label) == (os.getpid(), 2, "member")
        assert (process.core, process.host_cpu, process.alive) == (None, None, True)
        wait_until(lambda: seen.clusters()[0].alive, "the receive thread runs")
        (cluster,) = seen.clusters()
        assert (cluster.id, cluster.smem_bytes) == (2, SMEM_BYTES)
        assert 0 == cluster.charged_bytes < cluster.used_bytes < SMEM_BYTES
        (node,) = seen.nodes()
        assert (node.name, node.namespace, node.process) == ("member", "/", process.slot)

        rows = {row.kind: row for row in seen.endpoints()}
        _check_publisher(rows["publisher"], publisher.gid, qos)
        assert rows["subscription"].gid == subscription.gid
        gids = {row.gid for row in rows.values()}
        assert {row.gid for row in member.endpoints_of("/t")} == gids
        assert {row.gid for row in member.endpoints()} == gids


def test_a_publisher_that_stands_for_one_of_another_host(configured: str) -> None:
    """It has that one's gid, and its own counters."""
    gid = bytes(range(16))
    with Process(configured, label="member") as member, Platform(configured) as seen:
        publishers = [member.publisher("/t", STRING, Qos(), gid=gid) for _ in range(2)]
        subscription = member.subscription("/t", STRING, Qos())
        publishers[0].publish(b"12345678")
        claim = subscription.claim()
        assert claim is not None
        assert claim.publisher == gid
        claim.release()
        rows = [row for row in seen.endpoints() if row.kind == "publisher"]
        assert [(row.gid, row.counters.messages) for row in rows] == [(gid, 1), (gid, 0)]
        assert rows[0].id != rows[1].id
        with pytest.raises(ValueError, match="gid: expected the 16 bytes of a gid"):
            member.publisher("/t", STRING, Qos(), gid=b"short")


def test_a_node_stays_while_it_has_a_publisher(configured: str) -> None:
    with Process(configured, label="member") as member:
        node = member.node("told", "/")
        publisher = member.publisher("/t", STRING, Qos(), node=node)
        del node
        assert [row.node_name for row in member.endpoints_of("/t")] == ["told"]
        del publisher
        assert [node.name for node in member.nodes()] == ["member"]


def _check_publisher(row: EndpointInfo, gid: bytes, qos: Qos) -> None:
    assert (row.role, row.topic, row.type, row.type_hash) == ("topic", "/t", STRING, TYPE_HASH)
    assert (row.node_name, row.node_namespace, row.cluster) == ("member", "/", 2)
    assert (row.gid, row.qos, row.matched) == (gid, qos, 1)
    assert (row.counters.messages, row.counters.bytes, row.counters.lost) == (1, 8, 0)


def test_with_ends_what_it_began(platform: str) -> None:
    with Process(platform) as member:
        with Platform(platform) as seen:
            rows = seen.processes()
        with pytest.raises(ValueError, match="the view of the platform is closed"):
            seen.processes()
        assert rows[0].pid == os.getpid()  # rows stay valid after the view is closed
    with pytest.raises(ValueError, match="the process is closed"):
        member.epoch()
    assert not leftovers(platform)
    member.close()  # a second time changes nothing
