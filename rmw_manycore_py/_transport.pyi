# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transport of rmw_manycore without ROS: platforms seen, configured and joined."""

from typing import Any

class PlatformError(RuntimeError):
    """What the transport refuses or cannot do; its text says what to do."""

def platforms() -> list[str]:
    """Names of this user's platforms, dead or alive."""

def platform_directory(name: str) -> str:
    """Directory in which everything of a platform lies."""

def clean(name: str) -> list[str]:
    """Remove what a dead platform left; PlatformError while it is alive. Returns the removed paths."""

class Platform:
    """Read-only view of a platform: does not join it and does not keep it alive."""

    def __init__(self, name: str) -> None: ...
    def info(self) -> dict[str, Any]: ...
    def processes(self) -> list[dict[str, Any]]: ...
    def clusters(self) -> list[dict[str, Any]]: ...
    def nodes(self) -> list[dict[str, Any]]: ...
    def endpoints(self) -> list[dict[str, Any]]: ...
    def topic_table(self) -> list[dict[str, Any]]: ...

class Configurator:
    """A platform created before its first node and kept while this object lives."""

    def __init__(
        self,
        name: str,
        *,
        clusters: int,
        cores_per_cluster: int,
        smem_size: int,
        host_cpu_of_receive_thread: dict[int, int],
        topics: list[tuple[str, int, int, int]],
    ) -> None:
        """`smem_size` in bytes, 0 = from the machine; topics are (name, id, topic_dsm_size, cluster mask)."""

class Publisher:
    def publish(self, data: bytes) -> int:
        """Publish serialized bytes; returns the publication sequence number."""
    def matched(self) -> int: ...

class Subscription:
    def take(self) -> tuple[bytes, dict[str, Any]] | None:
        """Next serialized message with its metadata, or None."""
    def has_data(self) -> bool: ...
    def matched(self) -> int: ...
    def lost(self) -> int: ...

class Process:
    """A member of a platform without ROS, with one node named after its label."""

    def __init__(
        self, platform: str, cluster: int = 1, core: int | None = None, label: str = "tool"
    ) -> None: ...
    def publisher(self, topic: str, type: str, qos: dict[str, Any]) -> Publisher: ...
    def subscription(self, topic: str, type: str, qos: dict[str, Any]) -> Subscription: ...
    def epoch(self) -> int: ...
    def wait(self, seen: int, timeout_s: float | None = None) -> bool:
        """Sleep until the epoch is no longer `seen`; False after `timeout_s` seconds."""
    def notify(self) -> None: ...
