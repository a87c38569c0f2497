# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`radius_merge`: puts together what the searches found, and deals it out to the derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from manycore_ros_lite_msgs.msg import Pairs
from rclpy.node import Node

from rmw_manycore_py.ndt.messages.conversions import nanoseconds
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.localization.tiles import joined, split
from rmw_manycore_py.papers.roslite.messages import bytes_field, floats_field, pairs_of


@dataclass(frozen=True)
class MergeParameters:
    """Parameters of the node."""

    searches: int = parameter("searches", 1, min_value=1)
    derivatives: int = parameter("derivatives", 5, min_value=1)


class RadiusMerge(Node):
    """Publishes `ndt_pairs_1` and so on once `ndt_found` of all searches has come."""

    def __init__(self) -> None:
        super().__init__("radius_merge")
        self._p = declare(self, MergeParameters)
        self._pass: tuple[int, int] = (0, 0)
        self._found: dict[int, Any] = {}  # of the pass, by search
        self._outputs = [
            self.create_publisher(Pairs, f"ndt_pairs_{number}", 1)
            for number in range(1, self._p.derivatives + 1)
        ]
        self.create_subscription(Pairs, "ndt_found", self._on_found, self._p.searches)

    def _on_found(self, message: Any) -> None:
        of_message = (nanoseconds(message.stamp), message.pass_number)
        if of_message != self._pass:  # the pass before is lost if a part of it is missing
            self._pass, self._found = of_message, {}
        self._found[message.part] = message
        if len(self._found) == self._p.searches:
            self._deal()

    def _deal(self) -> None:
        parts = [self._found[part] for part in sorted(self._found)]
        merged = joined(map(pairs_of, parts)) if len(parts) > 1 else pairs_of(parts[0])
        for part, (counts, pairs) in enumerate(split(merged, self._p.derivatives)):
            message = Pairs(stamp=parts[0].stamp, pass_number=parts[0].pass_number, part=part)
            message.counts = bytes_field(counts)
            message.pairs = floats_field(np.ascontiguousarray(pairs))
            self._outputs[part].publish(message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(RadiusMerge)


if __name__ == "__main__":
    main()
