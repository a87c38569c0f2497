# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recent history of each topic and node, for charts."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.platform.monitor.sample import ClusterCounters
from rmw_manycore_py.platform.monitor.watch import Look

LENGTH = 600  # looks: five minutes at two a second

Names = tuple[str, ...]


class Series:
    """Quantities of all topics or nodes, one row per look."""

    def __init__(self, quantities: Names) -> None:
        self._quantities = quantities
        self._names: Names = ()
        self._values = self._empty(0)

    def _empty(self, count: int) -> NDArray[np.float32]:
        return np.full((LENGTH, len(self._quantities), count), np.nan, dtype=np.float32)

    @property
    def names(self) -> Names:
        """Names in the latest look."""
        return self._names

    def append(self, row: int, names: Names, values: NDArray[np.float32]) -> None:
        """Append the values of a look, with shape (quantities, names)."""
        if names is not self._names and names != self._names:
            place = {name: index for index, name in enumerate(self._names)}
            moved = self._empty(len(names))
            known = [index for index, name in enumerate(names) if name in place]
            moved[:, :, known] = self._values[:, :, [place[names[index]] for index in known]]
            self._values = moved
        self._names = names
        self._values[row] = values

    def of(self, name: str, rows: NDArray[np.intp]) -> dict[str, list[float | None]]:
        """Return the quantities of one name; None for looks without it."""
        if name not in self._names:
            return {}
        values = self._values[rows, :, self._names.index(name)]
        return {
            quantity: [None if np.isnan(one) else float(one) for one in values[:, column]]
            for column, quantity in enumerate(self._quantities)
        }


class History:
    """Series of the platform, and of each topic and process."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=LENGTH)
        self._count = 0
        self.topics = Series(("messages/s", "bytes/s", "queue %"))
        self.nodes = Series(("CPU %",))
        self.chip = Series(("value",))

    def append(self, look: Look, time_s: float) -> None:
        """Append a look."""
        row = self._count % LENGTH
        self._count += 1
        self._times.append(time_s)
        loads, graph = look.loads, look.graph
        queued, capacity = loads.fullest
        # A trace does not tell how much any queue holds.
        fill = 100 * queued / np.maximum(capacity, 1)
        if not capacity.any():
            fill = np.full(len(fill), np.nan)
        topics = np.array([loads.rates_hz, loads.bytes_per_s, fill], dtype=np.float32)
        self.topics.append(row, graph.topics, topics)
        cpu = [100 * loads.cpu_share(member.pid) for member in graph.members]
        by_name = {n: c for m, c in zip(graph.members, cpu, strict=True) for n in m.shown_names}
        values = np.array([list(by_name.values())], dtype=np.float32).reshape(1, -1)
        self.nodes.append(row, tuple(by_name), values)
        whole = {
            **totals_of(look),
            "bytes/s": float(loads.bytes_per_s.sum()),
            "fullest queue %": float(np.fmax.reduce(fill, initial=np.nan)),
            **dict(map(_smem_of, loads.after.clusters)),
        }
        self.chip.append(row, tuple(whole), np.array([list(whole.values())], dtype=np.float32))

    def _rows(self, newest: int | None) -> NDArray[np.intp]:
        length = len(self._times) if newest is None else min(newest, len(self._times))
        return np.arange(self._count - length, self._count, dtype=np.intp) % LENGTH

    def whole(self, newest: int | None = None) -> dict[str, Any]:
        """Return the series of the platform, or only the newest looks."""
        names = self.chip.names
        rows = self._rows(newest)
        return self._dated(rows, {name: self.chip.of(name, rows)["value"] for name in names})

    def of_topic(self, name: str, newest: int | None = None) -> dict[str, Any]:
        """Return the series of a topic."""
        rows = self._rows(newest)
        return self._dated(rows, self.topics.of(name, rows))

    def of_node(self, name: str, newest: int | None = None) -> dict[str, Any]:
        """Return the series of a node."""
        rows = self._rows(newest)
        return self._dated(rows, self.nodes.of(name, rows))

    def _dated(
        self, rows: NDArray[np.intp], series: dict[str, list[float | None]]
    ) -> dict[str, Any]:
        times = list(self._times)[len(self._times) - len(rows) :]
        return {"times": times, "series": series}


def _smem_of(cluster: ClusterCounters) -> tuple[str, float]:
    """Return name and value of a cluster's SMEM: its share, if its size is known."""
    if not cluster.smem_bytes:
        return f"SMEM {cluster.id} bytes", float(cluster.used_bytes)
    return f"SMEM {cluster.id} %", 100 * cluster.used_bytes / cluster.smem_bytes


def totals_of(look: Look) -> dict[str, float]:
    """Return messages per second and CPU usage of the whole platform."""
    cpu = sum(look.loads.cpu_share(member.pid) for member in look.graph.members)
    return {"messages/s": float(look.loads.rates_hz.sum()), "CPU %": 100 * cpu}
