# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Names that match a pattern, up to its bound."""

from __future__ import annotations

from typing import Any

import pytest

from rmw_manycore_bridge import pattern
from rmw_manycore_bridge.counters import CounterFile, status_path
from rmw_manycore_bridge.outside.loop import Mover
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Route

pytestmark = pytest.mark.unit

ALL = Route("topic", "outward", "/**", "/**", "", 0)
TEXT = frozenset({"std_msgs/msg/String"})


class Resting(Mover):
    def reconcile(self) -> None:
        """Nothing to adapt."""

    def close(self) -> None:
        """Nothing to close."""


# The counter files of names stay open as long as a process of the bridge.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_names_beyond_the_bound_are_reported(platform, monkeypatch, capsys) -> None:
    """Once in the log, and in the status as long as they are there."""
    monkeypatch.setattr(pattern, "MAX_NAMES", 2)
    nothing: Any = None
    names = {f"/topic{number}" for number in range(3)}
    with _transport.Process(platform, label="bridge"):
        file = CounterFile.create(status_path(platform, "outward", 0), [ALL])
        sides = Sides(ALL, file.rows[0], nothing, nothing, nothing)
        route = pattern.Pattern(
            Plan(platform, (ALL,)),
            sides,
            lambda wanted: {name: TEXT for name in sorted(names) if wanted(name)},
            lambda one: Resting(one.fail),
            {},
        )
        route.reconcile()
        route.reconcile()
        beyond = "topics: 3, 1 beyond the 2 that a pattern bridges"
        assert file.rows[0].as_dict()["reason"] == beyond
        assert capsys.readouterr().err.count("more than 2 names match") == 1
        names.remove("/topic0")
        route.reconcile()
        assert file.rows[0].as_dict()["reason"] == "topics: 2"
        route.close()
        file.close()
