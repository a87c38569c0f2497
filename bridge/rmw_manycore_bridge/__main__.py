# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridge process: python -m rmw_manycore_bridge PLAN DIRECTION LANE CLUSTER CORE."""

from __future__ import annotations

import resource
import signal
import sys

from rmw_manycore_bridge.time_slice import shorten_time_slice
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import DIRECTIONS


def main(arguments: list[str]) -> int:
    """Run one bridge process; started by `manycore run` and `manycore bridge`."""
    # SIGINT ends the process quietly until its own handler is set, also during `import rclpy`.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    _, hard_limit = resource.getrlimit(resource.RLIMIT_NOFILE)
    # Each name of a pattern needs a file.
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard_limit, hard_limit))
    shorten_time_slice()  # before any thread starts: threads inherit it
    from rmw_manycore_bridge.outside.interface import OutsideError
    from rmw_manycore_bridge.process import BridgeProcess

    plan, direction, lane, cluster, core = arguments
    way = DIRECTIONS[DIRECTIONS.index(direction)]
    try:
        process = BridgeProcess(Plan.from_json(plan), way, int(lane), (int(cluster), int(core)))
    except OutsideError as error:
        print(error, file=sys.stderr)
        return 1
    return process.run()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
