# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridge processes that a bench starts as parties."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.launch.bridge import bridge_program
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Direction, Route, arranged

FAST_DDS_OUTSIDE = OutsideSettings()


def bridge_command(
    inside: Session,
    routes: Sequence[Route],
    direction: Direction,
    core: int = 2,
    outside: OutsideSettings = FAST_DDS_OUTSIDE,
) -> Sequence[str]:
    """Return the command of the bridge process of a direction, in cluster 1."""
    plan = Plan(inside.platform, arranged(routes, 1), outside)
    return bridge_program(plan, direction, 0, Core(1, core), host_cpus=()).command
