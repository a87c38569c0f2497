# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A record is not overwritten while a reader holds it, however long that takes.

Readers are stopped at random moments, some of them in the middle of a record, until the publisher
has wrapped around its small topic DSM twice; then they read on.
"""

from __future__ import annotations

import random
import signal
from collections.abc import Iterator

import pytest

from support import IS_MANYCORE, KILLS
from support.nodes.load import SMALL_DSM_BYTES, TOPIC, check_until_killed, publish_without_rest
from support.processes.commands import peer_command

ALL_CLUSTERS = 0b11


@pytest.fixture
def small_topic(platform) -> Iterator[None]:
    """Create the platform with a small topic DSM of fixed size for the topic."""
    if not IS_MANYCORE:
        yield
        return
    from rmw_manycore_py.native._transport import Configurator, TopicConfiguration

    small = TopicConfiguration(
        f"/{TOPIC}", id=1, dsm_size_bytes=SMALL_DSM_BYTES, receiver_clusters=ALL_CLUSTERS
    )
    with Configurator(
        platform,
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=16 << 20,
        host_cpu_of_receive_thread={},
        topics=[small],
    ):
        yield


def test_readers_that_stop_in_the_middle(small_topic, start):
    readers = [start(peer_command(check_until_killed), cluster) for cluster in (1, 1, 2)]
    for reader in readers:
        reader.wait_for("works")
    publisher = start(peer_command(publish_without_rest))
    publisher.wait_for("overwritten")
    for _ in range(KILLS):
        reader = random.choice(readers)
        reader.signal(signal.SIGSTOP)
        publisher.skip_output()
        for _ in range(2):  # the first line may be about earlier messages
            publisher.wait_for("overwritten")
        reader.signal(signal.SIGCONT)
    for reader in readers:
        assert reader.is_running(), reader
        assert "torn" not in reader.output, reader
