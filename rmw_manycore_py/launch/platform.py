# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Brings a platform up before its first node, and clears it away after its last one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rmw_manycore_py import _transport
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.topology import RECEIVE_THREAD_CORE

GROWS = 0  # the size of a topic DSM that starts small


@contextmanager
def configured_platform(placement: Placement) -> Iterator[None]:
    """Create a platform, and remove it in the end unless others are on it."""
    topology = placement.topology
    try:
        configurator = _transport.Configurator(
            placement.name,
            clusters=len(topology.clusters),
            cores_per_cluster=topology.cores_per_cluster,
            smem_size=topology.smem_size,
            host_cpu_of_receive_thread={
                core.cluster: cpu
                for core, cpu in placement.host_cpus.items()
                if core.core == RECEIVE_THREAD_CORE
            },
            topics=[
                (topic.name, topic.id, topic.topic_dsm_size or GROWS, topic.receiver_mask)
                for topic in placement.topics
            ],
        )
    except _transport.PlatformError as error:
        raise ManycoreError(str(error)) from error
    try:
        yield
    finally:
        del configurator  # the platform goes with it


def remaining_users(name: str) -> list[str]:
    """Return who is still on a platform, by label and process id."""
    if name not in _transport.platforms():
        return []
    try:
        processes = _transport.Platform(name).processes()
    except _transport.PlatformError:
        return []  # it went away between two looks
    return [f"{row['label']} ({row['pid']})" for row in processes if row["alive"]]
