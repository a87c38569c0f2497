# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transport without ROS: platforms seen, configured and joined."""

from collections.abc import Mapping, Sequence
from typing import Any

_Row = dict[str, Any]

class PlatformError(RuntimeError):
    """Something is wrong with a platform; the message says what to do."""

def platforms() -> list[str]:
    """Return the names of this user's platforms, dead or alive."""

def platform_directory(name: str) -> str:
    """Return where everything of a platform lies."""

def clean(name: str) -> list[str]:
    """Remove what a dead platform left and return the paths; PlatformError while it lives."""

class Configurator:
    """Creates a platform before its first node, and keeps it while this object exists.

    `smem_size` is in bytes for each cluster, 0 = this machine's; `topics` are rows (name, topic id,
    topic DSM size in bytes, bit mask of the receiver clusters). When the object goes, so does the
    platform, unless somebody is on it.
    """

    def __init__(
        self,
        name: str,
        *,
        clusters: int,
        cores_per_cluster: int,
        smem_size: int,
        host_cpu_of_receive_thread: Mapping[int, int],
        topics: Sequence[tuple[str, int, int, int]],
    ) -> None: ...

class Platform:
    """A look at a platform: does not join it, and does not keep it alive."""

    def __init__(self, name: str) -> None: ...
    def info(self) -> _Row:
        """Return name, clusters, cores_per_cluster, smem_size, alive."""

    def processes(self) -> list[_Row]:
        """Return slot, pid, cluster, core, host_cpu, label, alive of each."""

    def nodes(self) -> list[_Row]:
        """Return handle, process (slot), name, namespace, enclave of each."""

    def endpoints(self) -> list[_Row]:
        """Return each publisher and subscription.

        Keys: kind (publisher, subscription), role (topic, request, reply), topic, type, type_hash,
        gid, node, namespace, cluster, process (slot), qos, matched, counters.
        """

    def clusters(self) -> list[_Row]:
        """Return id, smem_size, used, receive_thread_pid, messages, notifications and alive."""

    def topic_table(self) -> list[_Row]:
        """Return topic_name, topic_id, topic_dsm_size, receiver_clusters (bit mask) of each."""

class Publisher:
    """Publishes serialized messages."""

    def publish(self, data: bytes) -> int:
        """Publish and return the sequence number."""

    def matched(self) -> int: ...

class Subscription:
    """Takes serialized messages."""

    def take(self) -> tuple[bytes, _Row] | None: ...
    def has_data(self) -> bool: ...
    def matched(self) -> int: ...
    def lost(self) -> int: ...

class Process:
    """A member of a platform without ROS, with one node named after its label."""

    def __init__(
        self, platform: str, cluster: int = 1, core: int | None = None, label: str = "tool"
    ) -> None: ...
    def publisher(self, topic: str, type: str, qos: Mapping[str, Any]) -> Publisher: ...
    def subscription(self, topic: str, type: str, qos: Mapping[str, Any]) -> Subscription: ...
    def epoch(self) -> int:
        """Return a number that changes when something comes in."""

    def wait(self, seen: int, timeout_s: float | None = None) -> bool:
        """Sleep until the epoch is another than `seen`; False when the time is over."""

    def notify(self) -> None:
        """Wake whoever waits."""
