# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The six kinds of nodes, with the callback semantics of ros-realtime/reference-system."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node

from rmw_manycore_py.papers.reference_system.crunch import crunch
from rmw_manycore_py.papers.reference_system.ports import Input, Output
from rmw_manycore_py.papers.reference_system.sample import now_ns
from rmw_manycore_py.papers.reference_system.sample_path import SamplePath
from rmw_manycore_py.papers.reference_system.settings import KEEP_ALL, Settings

MS_PER_S = 1e3
NS_PER_MS = 1e6
# Queue depth of command nodes; other nodes use 1.
COMMAND_DEPTH = 10


class Kind:
    """Base of all kinds: inputs and outputs."""

    def __init__(self, node: Node, settings: Settings) -> None:
        self._node = node
        self._settings = settings
        self.inputs: list[Input] = []

    def report_losses(self) -> None:
        """Print the losses since the last report."""
        for each in self.inputs:
            each.report_losses()

    def _listen(
        self,
        callback: Callable[[Input, Any], None],
        depth: int | None = None,
        *,
        apart: bool = False,
    ) -> None:
        """Subscribe to all inputs; with `apart`, in a callback group each."""
        for topic in self._settings.inputs:
            group = MutuallyExclusiveCallbackGroup() if apart else None
            settings = self._settings if depth is None else replace(self._settings, depth=depth)
            self.inputs.append(Input(self._node, settings, topic, callback, group))

    def _outputs(self) -> list[Output]:
        return [Output(self._node, self._settings, topic) for topic in self._settings.outputs]

    def _every_period(self, callback: Callable[[], None]) -> None:
        self._node.create_timer(self._settings.period_ms / MS_PER_S, callback)

    def _publish_cached(self, output: Output, timestamp_ns: int) -> None:
        """Do the work, publish the cached inputs, and clear the cache."""
        result = crunch(self._settings.crunch_ms)
        cached = [each for each in self.inputs if each.cached is not None]
        missed = sum(each.missed(each.cached) for each in cached)
        output.publish(timestamp_ns, [each.cached for each in cached], missed, result)
        for each in cached:
            each.cached = None


class Sensor(Kind):
    """Publishes a message with its own record in every period."""

    def __init__(self, node: Node, settings: Settings) -> None:
        super().__init__(node, settings)
        (output,) = self._outputs()
        self._every_period(lambda: output.publish(now_ns()))


class Transform(Kind):
    """Publishes one message per input message."""

    def __init__(self, node: Node, settings: Settings) -> None:
        super().__init__(node, settings)
        (self._output,) = self._outputs()
        self._listen(self._pass_on)

    def _pass_on(self, source: Input, message: Any) -> None:
        timestamp_ns = now_ns()
        source.cached = message
        self._publish_cached(self._output, timestamp_ns)


class Fusion(Kind):
    """Publishes once both inputs have arrived; uses the newest message of each."""

    def __init__(self, node: Node, settings: Settings) -> None:
        super().__init__(node, settings)
        (self._output,) = self._outputs()
        self._listen(self._fuse)

    def _fuse(self, source: Input, message: Any) -> None:
        timestamp_ns = now_ns()
        source.cached = message
        if all(each.cached is not None for each in self.inputs):
            self._publish_cached(self._output, timestamp_ns)


class Cyclic(Kind):
    """Publishes the inputs received in each period; uses the newest message of each."""

    def __init__(self, node: Node, settings: Settings) -> None:
        super().__init__(node, settings)
        (self._output,) = self._outputs()
        self._listen(self._cache)
        self._every_period(lambda: self._publish_cached(self._output, now_ns()))

    def _cache(self, source: Input, message: Any) -> None:
        source.cached = message


class Intersection(Kind):
    """Several transforms in one node: the first input maps to the first output, and so on."""

    def __init__(self, node: Node, settings: Settings) -> None:
        super().__init__(node, settings)
        outputs = self._outputs()
        self._listen(self._pass_on, apart=True)
        self._output_of = dict(zip(self.inputs, outputs, strict=True))

    def _pass_on(self, source: Input, message: Any) -> None:
        timestamp_ns = now_ns()
        result = crunch(self._settings.crunch_ms)
        self._output_of[source].publish(timestamp_ns, [message], source.missed(message), result)


class Command(Kind):
    """Prints path and statistics of its input, at most once per `report_period_ms`."""

    def __init__(self, node: Node, settings: Settings) -> None:
        super().__init__(node, settings)
        self._report_period_ns = settings.report_period_ms * NS_PER_MS
        self._reported_ns = 0
        self._path = SamplePath(node.get_name())
        self._listen(self._report, COMMAND_DEPTH if settings.depth else KEEP_ALL)

    def _report(self, source: Input, message: Any) -> None:
        timestamp_ns = now_ns()
        missed = source.missed(message)
        if timestamp_ns >= self._reported_ns + self._report_period_ns:
            self._reported_ns = timestamp_ns
            print("\n".join(self._path.add(message, timestamp_ns, missed)), flush=True)


KINDS: dict[str, type[Kind]] = {
    "sensor": Sensor,
    "transform": Transform,
    "fusion": Fusion,
    "cyclic": Cyclic,
    "intersection": Intersection,
    "command": Command,
}
