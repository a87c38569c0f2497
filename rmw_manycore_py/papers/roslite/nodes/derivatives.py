# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`derivatives`: sums over pairs of a point and a voxel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from manycore_ros_lite_msgs.msg import Pairs, Sums
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.localization.alignment import sums_of
from rmw_manycore_py.papers.roslite.localization.options import OPTIONS
from rmw_manycore_py.papers.roslite.messages import pairs_of


@dataclass(frozen=True)
class DerivativesParameters:
    """Parameters of the node: which of the derivatives it is, from 1."""

    number: int = parameter("number", 1, min_value=1)


class Derivatives(Node):
    """Publishes `ndt_sums` for each `ndt_pairs_NUMBER`."""

    def __init__(self) -> None:
        super().__init__("derivatives")
        number = declare(self, DerivativesParameters).number
        self._complain = ThrottledLog(self.get_logger().warning)
        self._output = self.create_publisher(Sums, "ndt_sums", 1)
        self.create_subscription(Pairs, f"ndt_pairs_{number}", self._on_pairs, 1)

    def _on_pairs(self, message: Any) -> None:
        try:
            sums = sums_of(pairs_of(message), OPTIONS)
        except (ManycoreError, ValueError) as error:
            self._complain(f"ndt_pairs ignored: {error}")
            return
        self._output.publish(
            Sums(
                stamp=message.stamp,
                pass_number=message.pass_number,
                part=message.part,
                sums=sums,
            )
        )


def main() -> None:
    """Run the node until interrupted."""
    run_node(Derivatives)


if __name__ == "__main__":
    main()
