# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Notable events between two looks."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from rmw_manycore_py.platform.monitor.graph import Member
from rmw_manycore_py.platform.monitor.loads import Loads

Kind = Literal["died", "deadline", "lost", "platform"]


@dataclass(frozen=True)
class Event:
    """One line of the event list."""

    kind: Kind
    text: str
    node: str | None = None
    topic: str | None = None
    time_s: float = field(default_factory=time.time)  # since 1970

    def row(self) -> dict[str, Any]:
        """Return the JSON row."""
        return asdict(self)


def deaths(dead: Iterable[Member]) -> Iterator[Event]:
    """Yield an event per node of each process that died."""
    for member in dead:
        where = f"cluster {member.cluster}"
        where += "" if member.core is None else f" core {member.core}"
        for name in member.shown_names:
            yield Event("died", f"{name} died (pid {member.pid}, {where})", node=name)


def receive_thread_deaths(loads: Loads) -> Iterator[Event]:
    """Yield an event per receive thread whose pid has changed."""
    now = {cluster.id: cluster.receive_thread_pid for cluster in loads.after.clusters}
    for cluster in loads.before.clusters:
        pid = cluster.receive_thread_pid
        if pid and now.get(cluster.id, pid) != pid:
            yield Event("died", f"the receive thread of cluster {cluster.id} died (pid {pid})")
