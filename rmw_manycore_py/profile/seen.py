# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Entities and executions of a trace, as far as its events have come."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

from rmw_manycore_py.profile.model import CallbackKind

Address = tuple[int, int]  # pid, and address in that process


def _samples() -> array[int]:
    return array("q")


@dataclass(eq=False)
class NodeSeen:
    """A node."""

    index: int
    name: str
    pid: int
    has_rosout: bool = False


@dataclass(eq=False)
class PublisherSeen:
    """A publisher, and when it published."""

    index: int
    node: NodeSeen | None
    topic: str
    queue_depth: int
    times_ns: array[int] = field(default_factory=_samples)
    outside_callbacks: int = 0


@dataclass(eq=False)
class ExecutorSeen:
    """An executor, as CARET records it."""

    index: int
    kind: str


@dataclass(eq=False)
class GroupSeen:
    """A callback group, as CARET records it."""

    index: int
    kind: str
    executor: ExecutorSeen | None


@dataclass(eq=False)
class TriggerSeen:
    """A subscription, timer or service."""

    kind: CallbackKind
    node: NodeSeen | None = None
    name: str = ""  # topic or service
    index: int | None = None  # of the subscription
    queue_depth: int | None = None
    period_ns: int | None = None
    group: GroupSeen | None = None


@dataclass(eq=False)
class Registration:
    """A callback that was registered at an address."""

    owner: Address  # subscription of rclcpp, timer or service
    is_subscription: bool
    symbol: str = ""


@dataclass(eq=False)
class CallbackSeen:
    """A callback that ran, with its executions."""

    pid: int
    trigger: TriggerSeen
    symbol: str
    tids: set[int] = field(default_factory=set)
    begins_ns: array[int] = field(default_factory=_samples)
    durations_ns: array[int] = field(default_factory=_samples)
    offsets_ns: dict[PublisherSeen, array[int]] = field(default_factory=dict)
    queued_ns: array[int] = field(default_factory=_samples)
    age_ns: array[int] = field(default_factory=_samples)
    dispatch_ns: array[int] = field(default_factory=_samples)  # those with an idle thread
    next_message: int = 0  # of its topic
