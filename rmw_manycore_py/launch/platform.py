# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Creates a platform before its first node and removes it after the last; or joins one."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.launch.ros2_daemon import CURE, is_daemon
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.platform.topology import RECEIVE_THREAD_CORE, Core
from rmw_manycore_py.process.scheduling import own_scheduling

GROWS = 0  # size of a topic DSM that grows on demand


def configured_platform(placement: Placement) -> _transport.Configurator:
    """Create a platform; as a context manager, remove it at the end unless it is in use.

    :raises ManycoreError: if the platform exists; names the processes that use it.
    """
    topology = placement.topology
    inherited = own_scheduling()
    with translate_native_errors(), naming_users(placement.name):
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
                    transfer=topic.transfer,
                    priority=topic.priority,
                    synchronous=topic.synchronous,
                    zero_copy=topic.zero_copy,
                )
                for topic in placement.topics
            ],
            priority_of_receive_thread={
                cluster.id: priority
                for cluster in topology.clusters
                if (priority := placement.receive_priority(cluster.id, inherited))
            },
            numa_node_of_cluster={
                cluster.id: cluster.host.node
                for cluster in topology.clusters
                if cluster.host is not None and cluster.host.node is not None
            },
        )


@contextmanager
def naming_users(name: str) -> Iterator[None]:
    """Add the processes that use a platform to an error about it."""
    try:
        yield
    except _transport.PlatformError as error:
        users = remaining_users(name)
        if not users:
            raise
        raise ManycoreError(f"{error}; used by: {', '.join(users)}") from error


def remaining_users(name: str) -> list[str]:
    """Return the processes that still use a platform, by label and process id."""
    if name not in _transport.platforms():
        return []
    try:
        with _transport.Platform(name) as platform:
            living = [process for process in platform.processes() if process.alive]
            users = [
                f"the ros2 daemon ({process.pid}; `{CURE}` stops it)"
                if is_daemon(platform, process)
                else f"{process.label} ({process.pid})"
                for process in living
            ]
    except _transport.PlatformError:
        return []  # the platform was removed meanwhile
    return users


def occupied_cores(name: str, own_groups: Collection[int] = ()) -> set[Core]:
    """Return the occupied cores of a running platform.

    :param own_groups: process groups whose cores are not counted.
    :raises ManycoreError: if there is no such platform to join.
    """
    with _opened(name) as platform:
        return {
            Core(process.cluster, process.core)
            for process in platform.processes()
            if process.alive and process.core is not None and _group(process.pid) not in own_groups
        }


def _group(pid: int) -> int | None:
    try:
        return os.getpgid(pid)
    except ProcessLookupError:  # it has ended, or is not visible here
        return None


def check_joined(placement: Placement) -> None:
    """Raise ManycoreError if a node is placed on a core that the running platform lacks."""
    with _opened(placement.name) as platform:
        info = platform.info()
    for node in placement.nodes:
        if node.cluster > info.clusters or node.core >= info.cores_per_cluster:
            raise ManycoreError(
                f"'{node.name}' is placed on {node.place}, and platform '{placement.name}' has "
                f"{info.clusters} clusters x {info.cores_per_cluster} cores",
                EXIT_BAD_INPUT,
            )


def _opened(name: str) -> _transport.Platform:
    if name in _transport.platforms():
        with translate_native_errors():
            platform = _transport.Platform(name)
            if platform.info().alive:
                return platform
            platform.close()
    raise ManycoreError(
        f"there is no platform '{name}' to join: start it without --join, or name another one "
        "(platform: {name: ...} of the mapfile, or $MANYCORE_PLATFORM)"
    )
