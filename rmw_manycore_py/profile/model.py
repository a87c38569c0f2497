# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A profile as data; docs/reference/profile.md describes the file. Indices refer to its lists."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, TypeVar

from pydantic import BaseModel, ConfigDict, NonNegativeFloat, NonNegativeInt

FORMAT = "manycore profile"
VERSION = 1

Index = NonNegativeInt
Count = NonNegativeInt
Source = Literal["ros2_tracing", "caret_report", "manycore_trace"]
CallbackKind = Literal["subscription", "timer", "service", "client", "unknown"]
_Key = TypeVar("_Key", int, str)


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Distribution(_Row):
    """Samples of one quantity, in the unit of the key that holds them."""

    count: Count | None  # None: published without
    mean: float
    quantiles: tuple[float, ...]  # at the profile's quantile_shares


class Process(_Row):
    """A process of the application."""

    name: str
    threads: Count  # that ran a callback or published
    rest_ns: NonNegativeFloat | None = None  # CPU time a callback, in none and not before one


class Node(_Row):
    """A ROS node, by its full name."""

    name: str
    process: Index | None


class Publisher(_Row):
    """A publisher, and how often it published."""

    node: Index | None
    topic: str
    queue_depth: Count | None
    publications: Count | None
    outside_callbacks: Count | None  # of them: by threads that ran no callback
    interval_ns: Distribution | None
    size_bytes: Distribution | None
    publish_ns: Distribution | None = None  # from the call until readers see the message


class Subscription(_Row):
    """A subscription; a callback refers to it."""

    node: Index | None
    topic: str
    queue_depth: Count | None


class Executor(_Row):
    """An executor with its kind, as its source names it."""

    name: str
    kind: str


class CallbackGroup(_Row):
    """A callback group, and the executor that runs it."""

    name: str
    kind: str
    executor: Index | None


class Output(_Row):
    """Publications of one publisher during a callback."""

    publisher: Index
    count: Count | None
    offset_ns: Distribution | None  # from the callback's begin


class Callback(_Row):
    """A callback: its trigger, how long it runs, and what it publishes."""

    kind: CallbackKind
    node: Index | None
    trigger: str  # topic or service; empty for a timer
    subscription: Index | None
    period_ns: Count | None
    symbol: str
    process: Index | None
    threads: tuple[Index, ...]  # of its process
    group: Index | None
    executions: Count | None
    rate_hz: NonNegativeFloat | None
    wall_ns: Distribution | None
    cpu_ns: Distribution | None
    interval_ns: Distribution | None  # from begin to begin
    publishes: tuple[Output, ...]
    dispatch_ns: Distribution | None = None  # before its begin: the executor's work, and the take
    queued_ns: Distribution | None = None  # from the call of publish to the begin
    age_ns: Distribution | None = None  # likewise, from the first publication of the chain

    @property
    def load_cpus(self) -> float:
        """CPUs that the callback keeps busy: by its CPU time, or else its wall time."""
        time_ns = self.cpu_ns or self.wall_ns
        return (self.rate_hz or 0.0) * time_ns.mean / 1e9 if time_ns else 0.0

    @property
    def cpu_share(self) -> float | None:
        """Share of its wall time that the callback spends on a CPU, if known."""
        if self.cpu_ns is None or not self.wall_ns or not self.wall_ns.mean:
            return None
        return self.cpu_ns.mean / self.wall_ns.mean


class Hop(_Row):
    """A node of a chain, between the topics of its subscription and its publisher."""

    node: Index
    subscribes: str | None
    publishes: str | None


class Chain(_Row):
    """A chain of nodes that the source names."""

    name: str
    hops: tuple[Hop, ...]


class Coverage(_Row):
    """What the source holds that no callback or publisher above accounts for."""

    discarded_events: Count = 0  # by the tracer, for want of room
    begun_before: Count = 0  # callbacks that were running when the trace began
    unfinished: Count = 0  # callbacks without an end
    enclosing: Count = 0  # callbacks that ran an executor, so that others ran inside them
    ambiguous_publications: Count = 0
    publications_outside_callbacks: Count = 0
    publications_of_unknown_publishers: Count = 0


class Profile(_Row):
    """What an application does, apart from where it runs."""

    format: str
    version: int
    source: Source
    events: Count | None
    duration_ns: Count | None
    quantile_shares: tuple[float, ...]
    processes: tuple[Process, ...]
    nodes: tuple[Node, ...]
    publishers: tuple[Publisher, ...]
    subscriptions: tuple[Subscription, ...]
    executors: tuple[Executor, ...]
    groups: tuple[CallbackGroup, ...]
    callbacks: tuple[Callback, ...]
    chains: tuple[Chain, ...]
    coverage: Coverage
    receive_ns: NonNegativeFloat | None = None  # CPU time of a receive thread per eMCOS message


def indices_of(keys: Iterable[_Key]) -> dict[_Key, int]:
    """Return the index of each key, in the order of the first ones."""
    return {key: index for index, key in enumerate(dict.fromkeys(keys))}
