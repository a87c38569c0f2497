# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of applications from CARET's reports: an architecture, and statistics of nodes.

A report holds measured latencies of chains, too, in stats_path.yaml. They are not read: what a
profile predicts can be compared with them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from rmw_manycore_py.errors import FileError, Problem
from rmw_manycore_py.profile.caret_files import (
    UNDEFINED,
    Architecture,
    ArchitectureCallback,
    ArchitectureNode,
    CallbackStatistics,
    NamedPath,
    Statistic,
    Statistics,
    read,
)
from rmw_manycore_py.profile.model import (
    FORMAT,
    VERSION,
    Callback,
    CallbackGroup,
    CallbackKind,
    Chain,
    Coverage,
    Distribution,
    Executor,
    Hop,
    Node,
    Output,
    Profile,
    Publisher,
    Subscription,
    indices_of,
)

SHARES = (0.0, 0.5, 0.95, 0.99, 1.0)
_NS_PER_MS = 1_000_000
_KINDS: dict[str, CallbackKind] = {
    "subscription_callback": "subscription",
    "timer_callback": "timer",
    "service_callback": "service",
}


def import_report(directory: Path) -> Profile:
    """Return the profile of a report with its architecture.

    :raises FileError: if a file is not as CARET writes it.
    """
    paths = sorted(directory.rglob("architecture*.yaml"))
    architecture = _with_most_chains([read(path, Architecture) for path in paths])
    statistics: dict[str, CallbackStatistics] = {}
    for path in sorted(directory.rglob("stats_node.yaml")):
        for node in read(path, Statistics).root.values():
            statistics.update(node.callbacks)
    known = {one.callback_name for node in architecture.nodes for one in node.callbacks}
    unknown = sorted(set(statistics) - known)
    if unknown:
        raise FileError(Problem(paths[0], 0, "", f"the callback {unknown[0]}", "none"))
    return _Report(architecture, statistics).profile()


def _with_most_chains(architectures: list[Architecture]) -> Architecture:
    """Return the most complete one: a report holds one with chains and one without."""
    return max(architectures, key=lambda one: len(one.named_paths))


class _Report:
    """An architecture with its statistics; indices are those of the profile."""

    def __init__(
        self, architecture: Architecture, statistics: Mapping[str, CallbackStatistics]
    ) -> None:
        self._architecture = architecture
        self._statistics = statistics
        nodes = architecture.nodes
        self._nodes = indices_of(node.node_name for node in nodes)
        # A node may have several publishers of one topic.
        self._publishes = [(node, publish) for node in nodes for publish in node.publishes]
        self._subscriptions = indices_of(
            one.callback_name for node in nodes for one in node.subscribes
        )
        groups = [group for node in nodes for group in node.callback_groups]
        self._group_of = {
            name: index for index, group in enumerate(groups) for name in group.callback_names
        }
        self._groups = groups
        self._executors = [one for one in architecture.executors if one.callback_group_names]

    def profile(self) -> Profile:
        nodes = self._architecture.nodes
        return Profile(
            format=FORMAT,
            version=VERSION,
            source="caret_report",
            events=None,
            duration_ns=None,
            quantile_shares=SHARES,
            processes=(),
            nodes=tuple(Node(name=name, process=None) for name in self._nodes),
            publishers=tuple(
                _publisher(self._nodes[node.node_name], publish.topic_name)
                for node, publish in self._publishes
            ),
            subscriptions=tuple(
                Subscription(
                    node=self._nodes[node.node_name], topic=one.topic_name, queue_depth=None
                )
                for node in nodes
                for one in node.subscribes
            ),
            executors=tuple(
                Executor(name=one.executor_name, kind=one.executor_type) for one in self._executors
            ),
            groups=self._callback_groups(),
            callbacks=tuple(self._callback(node, one) for node in nodes for one in node.callbacks),
            chains=tuple(map(self._chain, self._architecture.named_paths)),
            coverage=Coverage(),
        )

    def _callback_groups(self) -> tuple[CallbackGroup, ...]:
        executor_of = {
            name: index
            for index, executor in enumerate(self._executors)
            for name in executor.callback_group_names
        }
        return tuple(
            CallbackGroup(
                name=group.callback_group_name,
                kind=group.callback_group_type,
                executor=executor_of.get(group.callback_group_name),
            )
            for group in self._groups
        )

    def _callback(self, node: ArchitectureNode, one: ArchitectureCallback) -> Callback:
        statistics = self._statistics.get(one.callback_name)
        wall_ns = _distribution(statistics.Latency if statistics else None)
        interval_ns = _distribution(statistics.Period if statistics else None)
        return Callback(
            kind=_KINDS[one.callback_type],
            node=self._nodes[node.node_name],
            trigger=one.topic_name or one.service_name,
            subscription=self._subscriptions.get(one.callback_name),
            period_ns=one.period_ns,
            symbol=one.symbol,
            process=None,
            threads=(),
            group=self._group_of.get(one.callback_name),
            executions=None,
            rate_hz=_rate_hz(statistics, interval_ns),
            wall_ns=wall_ns,
            cpu_ns=None,
            interval_ns=interval_ns,
            publishes=tuple(
                Output(publisher=index, count=None, offset_ns=None)
                for index, (_, publish) in enumerate(self._publishes)
                if one.callback_name in publish.callback_names
            ),
        )

    def _chain(self, path: NamedPath) -> Chain:
        return Chain(
            name=path.path_name,
            hops=tuple(
                Hop(
                    node=self._nodes[one.node_name],
                    subscribes=_unless_undefined(one.subscribe_topic_name),
                    publishes=_unless_undefined(one.publish_topic_name),
                )
                for one in path.node_chain
            ),
        )


def _publisher(node: int, topic: str) -> Publisher:
    return Publisher(
        node=node,
        topic=topic,
        queue_depth=None,
        publications=None,
        outside_callbacks=None,
        interval_ns=None,
        size_bytes=None,
    )


def _distribution(statistic: Statistic | None) -> Distribution | None:
    """Return a statistic in ms as a distribution in ns."""
    if statistic is None or statistic.avg is None:
        return None
    points = (statistic.min, statistic.p50, statistic.p95, statistic.p99, statistic.max)
    quantiles = tuple(point * _NS_PER_MS for point in points if point is not None)
    if len(quantiles) < len(points):
        return None
    return Distribution(count=None, mean=statistic.avg * _NS_PER_MS, quantiles=quantiles)


def _rate_hz(
    statistics: CallbackStatistics | None, interval_ns: Distribution | None
) -> float | None:
    """Return the rate; CARET's frequency counts incomplete seconds at both ends of the run."""
    if interval_ns is not None and interval_ns.mean > 0:
        return 1e9 / interval_ns.mean
    return statistics.Frequency.avg if statistics else None


def _unless_undefined(name: str) -> str | None:
    return None if name == UNDEFINED else name
