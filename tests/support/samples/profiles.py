# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Made profiles with known times."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.prediction import Site, Sites
from rmw_manycore_py.profile.model import (
    FORMAT,
    VERSION,
    Callback,
    Coverage,
    Distribution,
    Node,
    Output,
    Process,
    Profile,
    Publisher,
    Subscription,
)

SECONDS = 10
MS = 1_000_000
NODES = ("/camera", "/filter", "/sink")
TOPICS = ("/image", "/small")


def steady(value: float) -> Distribution:
    """Return the distribution of a value that is always the same."""
    return Distribution(count=1, mean=value, quantiles=(value, value))


def callback(node: int, wall_ms: float, **fields: Any) -> Callback:
    """Return a callback at 10 Hz that always takes as long."""
    values: dict[str, Any] = {
        "kind": "subscription", "trigger": "", "subscription": None, "period_ns": None,
        "symbol": "", "process": node, "threads": (0,), "group": None,
        "executions": 10 * SECONDS, "rate_hz": 10.0, "cpu_ns": None,
        "interval_ns": steady(100 * MS), "publishes": (), "dispatch_ns": steady(0.0),
    }  # fmt: skip
    return Callback(node=node, wall_ns=steady(wall_ms * MS), **{**values, **fields})


def publishes(publisher: int, offset_ms: float, count: int = 10 * SECONDS) -> tuple[Output, ...]:
    """Return one publication in each execution."""
    return (Output(publisher=publisher, count=count, offset_ns=steady(offset_ms * MS)),)


def pipeline(**fields: Any) -> Profile:
    """Return camera, filter and sink, with callbacks of 2, 30 and 1 ms.

    The camera publishes 1 ms after its callback's begin, the filter after 20 ms.
    """
    values: dict[str, Any] = {
        "format": FORMAT, "version": VERSION, "source": "manycore_trace", "events": 0,
        "duration_ns": SECONDS * 10**9, "quantile_shares": (0.0, 1.0),
        "processes": tuple(Process(name=name[1:], threads=1) for name in NODES),
        "nodes": tuple(Node(name=name, process=index) for index, name in enumerate(NODES)),
        "publishers": tuple(
            Publisher(
                node=node, topic=topic, queue_depth=None, publications=10 * SECONDS,
                outside_callbacks=0, interval_ns=steady(100 * MS), size_bytes=steady(1000),
                publish_ns=steady(0.0),
            )
            for node, topic in enumerate(TOPICS)
        ),
        "subscriptions": tuple(
            Subscription(node=node, topic=topic, queue_depth=2)
            for node, topic in enumerate(TOPICS, start=1)
        ),
        "executors": (), "groups": (), "chains": (), "coverage": Coverage(),
        "callbacks": (
            callback(0, 2, kind="timer", period_ns=100 * MS, publishes=publishes(0, 1)),
            callback(1, 30, trigger="/image", subscription=0, publishes=publishes(1, 20)),
            callback(2, 1, trigger="/small", subscription=1),
        ),
    }  # fmt: skip
    return Profile(**{**values, **fields})


def queued(depth: int) -> Profile:
    """Return the pipeline with queues of a depth."""
    deep = {"queue_depth": depth}
    usual = pipeline()
    return pipeline(
        subscriptions=tuple(one.model_copy(update=deep) for one in usual.subscriptions),
        publishers=tuple(one.model_copy(update=deep) for one in usual.publishers),
    )


def sites(*clusters: int, host_cpus: tuple[int, ...] = (0, 1, 2)) -> Sites:
    """Return the places of the pipeline's nodes."""
    places = zip(NODES, clusters or (1, 1, 1), host_cpus, strict=True)
    return Sites(
        {
            name: Site(Core(cluster, number), (cpu,))
            for number, (name, cluster, cpu) in enumerate(places, start=1)
        },
        receive_cpus=dict.fromkeys(clusters, 3),
    )
