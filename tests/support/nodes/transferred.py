# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A platform whose topics are transferred between clusters, for tests to start first."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from support.nodes.ros import announce

KINDS = ("message", "session", "async")
DSM_BYTES = 4 << 20


def configure(kind: str, topics: list[str], clusters: int, synchronous: Sequence[str] = ()) -> None:
    """Configure a platform on which the topics are transferred; it stays until its input ends.

    :param synchronous: those of `topics` that are published synchronously.
    """
    from rmw_manycore_py.native import _transport

    table = [
        _transport.TopicConfiguration(
            topic,
            id=number,
            dsm_size_bytes=DSM_BYTES,
            receiver_clusters=0,
            transfer=kind,  # type: ignore[arg-type]
            synchronous=topic in synchronous,
        )
        for number, topic in enumerate(topics, start=1)
    ]
    with _transport.Configurator(
        os.environ["MANYCORE_PLATFORM"],
        clusters=clusters,
        cores_per_cluster=4,
        smem_bytes=64 << 20,
        host_cpu_of_receive_thread={},
        topics=table,
    ):
        announce("configured")
        sys.stdin.read()
