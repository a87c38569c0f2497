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

def charge_smem(platform: str, size_bytes: int) -> None:
    """Count so many bytes of this process, outside the segment, as SMEM of its cluster.

    They replace what it had counted before, and end with it; PlatformError where there is no room.
    """

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
        """Return the state of each.

        Keys: id, smem_size, used, charged (of used), receive_thread_pid, messages, notifications,
        alive.
        """

    def topic_table(self) -> list[_Row]:
        """Return topic_name, topic_id, topic_dsm_size, receiver_clusters (bit mask) of each."""

class Publisher:
    """Publishes serialized messages; `gid` is what subscriptions know it by, 16 bytes."""

    gid: bytes
    def publish(
        self,
        data: bytes,
        source_timestamp_ns: int | None = None,
        client: bytes | None = None,
        number: int = 0,
    ) -> int:
        """Publish and return the sequence number; the time is now where none is given.

        Requests and replies carry the client, by the gid of its reply subscription, and the
        client's number of the request; a reply reaches that client only.
        """

    def publish_from(self, address: int, size: int, source_timestamp_ns: int | None = None) -> int:
        """Publish `size` bytes of this process's memory."""

    def matched(self) -> int: ...

class Claim:
    """A record in its place in the topic DSM. The publisher cannot reuse it before `release`.

    A subscription has one claim at a time. `number` is the client's of a request or reply;
    `sequence` counts up by one with each message of the publisher.
    """

    address: int
    size: int
    data: bytes
    publisher: bytes
    client: bytes
    number: int
    source_timestamp_ns: int
    sequence: int
    def release(self) -> None: ...

class Subscription:
    """Takes serialized messages; `gid` names a client where it is the one of its replies."""

    gid: bytes
    def claim(self) -> Claim | None:
        """Return the next record without a copy."""

    def take(self) -> tuple[bytes, _Row] | None: ...
    def has_data(self) -> bool: ...
    def matched(self) -> int: ...
    def lost(self) -> int: ...

class Process:
    """A member of a platform without ROS, with one node named after its label."""

    def __init__(
        self, platform: str, cluster: int = 1, core: int | None = None, label: str = "tool"
    ) -> None: ...
    def publisher(
        self,
        topic: str,
        type: str,
        qos: Mapping[str, Any],
        role: str = "topic",
        type_hash: str = "",
    ) -> Publisher:
        """Return a publisher of a topic, or of a service's requests or replies (its role)."""

    def subscription(
        self,
        topic: str,
        type: str,
        qos: Mapping[str, Any],
        role: str = "topic",
        type_hash: str = "",
    ) -> Subscription:
        """Return a subscription of a topic, or of a service's requests or replies (its role)."""

    def endpoints_of(self, topic: str) -> list[_Row]:
        """Return rows as `Platform.endpoints` of one topic or service."""

    def graph_generation(self) -> int:
        """Return a number that changes when a node or endpoint comes or goes."""

    def watch_graph(self) -> None:
        """Have changes of the graph end `wait` too, from now on."""

    def epoch(self) -> int:
        """Return a number that changes when something comes in."""

    def wait(self, seen: int, timeout_s: float | None = None) -> bool:
        """Sleep until the epoch is another than `seen`; False when the time is over."""

    def notify(self) -> None:
        """Wake whoever waits."""
