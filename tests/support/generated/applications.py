# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Applications made at random, in which much happens at the same time: their times are round."""

from __future__ import annotations

import json
import random
import sys
from dataclasses import dataclass
from typing import Any

from rmw_manycore_py.profile.model import Node, Process, Profile, Publisher, Subscription
from support.nodes import scripted
from support.samples.profiles import MS, SECONDS, callback, pipeline, publishes, steady

PERIODS_MS = (10, 20, 25, 40, 50, 100)


@dataclass(frozen=True)
class Made:
    """A callback: each publishes to a topic of its own, in the middle or at the end.

    :ivar trigger: a period in ms, or a topic.
    """

    node: int
    trigger: int | str
    output: str
    cpu_us: int
    offset_us: int
    rate_hz: float


class Application:
    """Nodes with timers and subscriptions, on a few cores."""

    def __init__(self, seed: int, *, nodes: int, clusters: int, cores: int) -> None:
        self._random = random.Random(seed)
        self._nodes = nodes
        self._callbacks: list[Made] = []
        # The order in which nodes publish to each other is not that of the mapfile.
        for count, node in enumerate(self._random.sample(range(nodes), nodes)):
            inputs = [one.output for one in self._callbacks]
            timers = self._random.sample(PERIODS_MS, 2 if count < 2 else self._random.randint(0, 1))
            chosen = self._random.sample(inputs, min(2, len(inputs))) if count >= 2 else []
            for trigger in (*timers, *chosen):
                self._add(node, trigger)
        self._places = [
            (self._random.randint(1, clusters), self._random.randint(1, cores))
            for _ in range(nodes)
        ]

    def _add(self, node: int, trigger: int | str) -> None:
        rates = {one.output: one.rate_hz for one in self._callbacks}
        cpu_us = 100 * self._random.randint(1, 15)
        self._callbacks.append(
            Made(
                node,
                trigger,
                f"/topic_{len(self._callbacks)}",
                cpu_us,
                self._random.choice([cpu_us // 2, cpu_us]),
                rates[trigger] if isinstance(trigger, str) else 1000 / trigger,
            )
        )

    def mapfile(self) -> dict[str, Any]:
        """Return the mapfile."""
        nodes = {}
        for index, (cluster, core) in enumerate(self._places):
            callbacks = [[one.trigger, one.output] for one in self._callbacks if one.node == index]
            command = [sys.executable, scripted.__file__, f"node_{index}", json.dumps(callbacks)]
            nodes[f"node_{index}"] = {"command": command, "cluster": cluster, "core": core}
        return {"platform": "coolidge", "allow_shared_cores": True, "nodes": nodes}

    def profile(self) -> Profile:
        """Return the profile; its order of nodes is not that of the mapfile."""
        order = self._random.sample(range(self._nodes), self._nodes)
        made = sorted(self._callbacks, key=lambda one: order.index(one.node))
        heard = [one for one in made if isinstance(one.trigger, str)]
        names = [f"node_{index}" for index in order]
        return pipeline(
            processes=tuple(Process(name=name, threads=1, rest_ns=self._ns()) for name in names),
            nodes=tuple(Node(name=f"/{name}", process=at) for at, name in enumerate(names)),
            publishers=tuple(
                Publisher(
                    node=order.index(one.node), topic=one.output, queue_depth=None,
                    publications=round(SECONDS * one.rate_hz), outside_callbacks=0,
                    interval_ns=steady(1e9 / one.rate_hz), size_bytes=steady(1000),
                    publish_ns=steady(self._ns()),
                )
                for one in made
            ),
            subscriptions=tuple(
                Subscription(node=order.index(one.node), topic=str(one.trigger), queue_depth=10)
                for one in heard
            ),
            callbacks=tuple(
                callback(
                    order.index(one.node),
                    one.cpu_us / 1000,
                    executions=round(SECONDS * one.rate_hz),
                    rate_hz=one.rate_hz,
                    interval_ns=steady(1e9 / one.rate_hz),
                    dispatch_ns=steady(self._ns()),
                    publishes=publishes(at, one.offset_us / 1000, round(SECONDS * one.rate_hz)),
                    **(
                        {"trigger": one.trigger, "subscription": heard.index(one)}
                        if isinstance(one.trigger, str)
                        else {"kind": "timer", "period_ns": one.trigger * MS}
                    ),
                )
                for at, one in enumerate(made)
            ),
        )  # fmt: skip

    def _ns(self) -> float:
        return 1000 * self._random.choice([10, 20, 50])
