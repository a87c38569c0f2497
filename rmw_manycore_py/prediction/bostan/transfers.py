# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Transfers as they are asked for, what came of them, and which of them the chip can do at all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.prediction.bostan.dma import Method
from rmw_manycore_py.prediction.bostan.memory import MemoryKind
from rmw_manycore_py.prediction.bostan.packets import flits_of, payloads
from rmw_manycore_py.prediction.bostan.parameters import RX_PER_NODE, UC_PER_NODE, Parameters
from rmw_manycore_py.prediction.bostan.routing import Route, checked

# "none": senders send as fast as they can. "credits": a transfer has no more flits under way than
# its share of every FIFO on its route has room for.
FlowControl = Literal["none", "credits"]
# By the names that results have.
FLOW_CONTROLS: dict[str, FlowControl] = {"without flow control": "none", "with credits": "credits"}


@dataclass(frozen=True)
class Transfer:
    """One transfer: bytes from a memory at the start of a route into one at its end."""

    route: Route
    size_bytes: int
    method: Method
    source: MemoryKind
    destination: MemoryKind = "CC SMEM"


@dataclass
class Outcome:
    """What came of a transfer, in packets; its last byte was written in the cycle `end`."""

    sent: int = 0
    delivered: int = 0
    delivered_bytes: int = 0
    end: float = 0.0

    @property
    def lost(self) -> int:
        """Packets that met a full FIFO."""
        return self.sent - self.delivered


def check(transfers: Sequence[Transfer]) -> None:
    """Refuse what the chip cannot do.

    :raises ManycoreError: which names the transfer, or the node and what it has too few of.
    """
    for transfer in transfers:
        checked(transfer.route)
        payloads(transfer.size_bytes)
        _check_memory(transfer.route[0], transfer.source)
        _check_memory(transfer.route[-1], transfer.destination)
    senders = [t.route[0] for t in transfers if t.method == "UC"]
    _check_interfaces("UC", UC_PER_NODE, senders)
    _check_interfaces("Rx", RX_PER_NODE, [t.route[-1] for t in transfers])


def _check_memory(node: str, memory: MemoryKind) -> None:
    if (node[0] == "C") != (memory == "CC SMEM"):
        raise ManycoreError(f"node {node} has no {memory}", EXIT_BAD_INPUT)


def _check_interfaces(name: str, limit: int, users: Sequence[str]) -> None:
    for node, count in Counter(users).items():
        if count > limit:
            message = f"node {node}: {count} transfers need a {name}, expected at most {limit}"
            raise ManycoreError(message, EXIT_BAD_INPUT)


def windows(transfers: Sequence[Transfer], parameters: Parameters) -> list[float]:
    """Return how many flits of each transfer may be under way without any FIFO overflowing.

    :raises ManycoreError: when a share of a FIFO cannot take a packet.
    """
    sharing = Counter(fifo for transfer in transfers for fifo in _fifos(transfer))
    found = []
    for transfer in transfers:
        window = parameters.fifo_flits / max(sharing[fifo] for fifo in _fifos(transfer))
        longest = flits_of(payloads(transfer.size_bytes)[0], parameters.header_flits)
        if window < longest:
            message = (
                f"flow control for {transfer.route[0]} to {transfer.route[-1]}: a packet has "
                f"{longest:g} flits, its share of a FIFO {window:g}; use fewer transfers"
            )
            raise ManycoreError(message, EXIT_BAD_INPUT)
        found.append(window)
    return found


def _fifos(transfer: Transfer) -> list[tuple[str, str, str]]:
    """Return the FIFOs of a route: where a packet comes from, the router, where it goes to."""
    places = [*transfer.route, "interface"]
    return list(zip(places, places[1:], places[2:], strict=False))
