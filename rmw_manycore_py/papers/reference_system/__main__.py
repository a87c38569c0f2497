# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs one node of the reference system, selected by its parameters.

python -m rmw_manycore_py.papers.reference_system --ros-args -r __node:=PointsTransformerFront \
    -p kind:=transform -p inputs:="[FrontLidarDriver]"
"""

import signal
import sys
from contextlib import suppress

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.reference_system.kinds import KINDS
from rmw_manycore_py.papers.reference_system.settings import read_settings


def main() -> int:
    """Run the node until interrupted."""
    # rclpy's own handler ends spinning. A KeyboardInterrupt in the middle of a conversion of a
    # message becomes a RuntimeError of pybind11.
    signal.signal(signal.SIGINT, lambda _number, _frame: None)
    rclpy.init()
    with suppress(ExternalShutdownException):
        node = Node("reference_node")
        try:
            settings = read_settings(node, KINDS)
        except ManycoreError as error:
            print(f"{node.get_name()}: {error}", file=sys.stderr)
            return error.exit_status
        kind = KINDS[settings.kind](node, settings)
        try:
            rclpy.spin(node)
        except RCLError:  # a callback published while the interrupt invalidated the context
            if rclpy.ok():
                raise
        finally:
            kind.report_losses()
    return 0


if __name__ == "__main__":
    sys.exit(main())
