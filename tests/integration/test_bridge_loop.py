# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The thread of the platform side wakes up for every change it is notified of."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.ros import announce

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]


def change_while_looking(platform: str) -> None:
    """Notify a loop of a change while it reads the graphs; return whether it reads them again."""
    from rmw_manycore_bridge.inside import Inside
    from rmw_manycore_bridge.outside.loop import Mover
    from rmw_manycore_py.routes.plan import Plan

    class Looker(Mover):
        def __init__(self, during_the_first: Callable[[], None]) -> None:
            super().__init__(announce)
            self._looks = iter([during_the_first, again.set])

        def reconcile(self) -> None:
            next(self._looks, again.set)()

        def close(self) -> None:
            pass

    again = threading.Event()
    inside = Inside(Plan(platform, ()), (1, 0), "looker", lambda: None)
    inside.movers.append(Looker(inside.graphs_changed))
    inside.start()
    announce(f"looked again: {again.wait(TIMEOUT_S)}")
    inside.stop()
    announce("stopped")


def test_a_change_during_a_check_is_checked(bridge) -> None:
    peer = bridge.outside(change_while_looking, bridge.platform)
    peer.wait_for("^looked again: True$", 2 * TIMEOUT_S)
    peer.wait_for("^stopped$")
