# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time of transfers between clusters: none in shared memory, over a bus, or over Bostan's NoC."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from functools import cache

from rmw_manycore_py.prediction.bostan import routing
from rmw_manycore_py.prediction.bostan.chip import run
from rmw_manycore_py.prediction.bostan.parameters import Parameters
from rmw_manycore_py.prediction.bostan.topology import CLUSTERS, SUBSYSTEMS, Node, io_node
from rmw_manycore_py.prediction.bostan.transfers import Transfer
from rmw_manycore_py.prediction.target import Target

Link = tuple[str, str]
EMCOS_MESSAGE_BYTES = 64
_FEW_BYTES, _MANY_BYTES = 248, 24_800  # one packet, and a hundred


class Network:
    """Links that transfers occupy one after the other.

    :ivar busy_ns: by link, for how long it was occupied.
    """

    def __init__(self, target: Target) -> None:
        self._target = target
        self._free_ns: dict[Link, float] = defaultdict(float)
        self.busy_ns: dict[Link, float] = defaultdict(float)
        self.bytes: dict[Link, int] = defaultdict(int)
        self._path: Callable[[int, int], tuple[Link, ...]] = _paths[target.network]

    def send(self, now: float, source: int, destination: int, size_bytes: int) -> float:
        """Return the time until an eMCOS message, with this much data, is in another cluster."""
        return self.transfer(now, source, destination, EMCOS_MESSAGE_BYTES + size_bytes)

    def transfer(self, now: float, source: int, destination: int, size_bytes: int) -> float:
        """Return the time of a transfer, waiting for busy links included."""
        if source == destination or self._target.network == "memory":
            return 0.0
        path = self._path(source, destination)
        begin = max([now, *(self._free_ns[link] for link in path)])
        start_ns, per_byte_ns = self._costs(len(path))
        busy_ns = size_bytes * per_byte_ns
        for link in path:
            self._free_ns[link] = begin + busy_ns
            self.busy_ns[link] += busy_ns
            self.bytes[link] += size_bytes
        return begin - now + start_ns + busy_ns

    def _costs(self, hops: int) -> tuple[float, float]:
        if self._target.network == "bus":
            return self._target.ns("message_us"), 1e3 / self._target.bytes_per_us
        return _noc_costs(hops)


def _bus(*_: int) -> tuple[Link, ...]:
    return (("bus", "bus"),)


@cache
def _noc(source: int, destination: int) -> tuple[Link, ...]:
    route = routing.shortest(_node(source), _node(destination))
    return tuple(routing.hops_of(route))


def _node(cluster: int) -> Node:
    """Return the node of a cluster; those beyond the compute clusters are the I/O subsystems."""
    if cluster <= CLUSTERS:
        return f"C{cluster}"
    return io_node(SUBSYSTEMS[(cluster - CLUSTERS - 1) % len(SUBSYSTEMS)], 0)


@cache
def _noc_costs(hops: int) -> tuple[float, float]:
    """Return start and time per byte of a transfer, from the model of packets on an idle NoC."""
    column = ("C1", "C2", "C3", "C4", "C8", "C12", "C16")
    route = routing.checked(column[: min(hops, len(column) - 1) + 1])
    parameters = Parameters()
    few, many = (
        run([Transfer(route, size, "UC", "CC SMEM")], parameters).end
        for size in (_FEW_BYTES, _MANY_BYTES)
    )
    per_byte = (many - few) / (_MANY_BYTES - _FEW_BYTES)
    cycle_ns = parameters.cycle_s * 1e9
    return (few - per_byte * _FEW_BYTES) * cycle_ns, per_byte * cycle_ns


_paths: dict[str, Callable[[int, int], tuple[Link, ...]]] = {
    "memory": _bus,
    "bus": _bus,
    "bostan": _noc,
}
