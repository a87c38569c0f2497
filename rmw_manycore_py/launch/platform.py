# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Brings a platform up before its first node, and clears it away after its last one."""

from __future__ import annotations

from rmw_manycore_py import _transport
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.native_errors import translate_native_errors
from rmw_manycore_py.topology import RECEIVE_THREAD_CORE

GROWS = 0  # the size of a topic DSM that starts small


def configured_platform(placement: Placement) -> _transport.Configurator:
    """Create a platform; as a context manager remove it in the end unless others are on it."""
    topology = placement.topology
    with translate_native_errors():
        return _transport.Configurator(
            placement.name,
            clusters=len(topology.clusters),
            cores_per_cluster=topology.cores_per_cluster,
            smem_bytes=topology.smem_size,
            host_cpu_of_receive_thread={
                core.cluster: cpu
                for core, cpu in placement.host_cpus.items()
                if core.core == RECEIVE_THREAD_CORE
            },
            topics=[
                _transport.TopicConfiguration(
                    topic.name,
                    id=topic.id,
                    dsm_size_bytes=topic.topic_dsm_size or GROWS,
                    receiver_clusters=topic.receiver_mask,
                )
                for topic in placement.topics
            ],
        )


def remaining_users(name: str) -> list[str]:
    """Return who is still on a platform, by label and process id."""
    if name not in _transport.platforms():
        return []
    try:
        with _transport.Platform(name) as platform:
            processes = platform.processes()
    except _transport.PlatformError:
        return []  # it went away between two looks
    return [f"{process.label} ({process.pid})" for process in processes if process.alive]
