# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The chip put together: transfers that start at once, and what came of each."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from rmw_manycore_py.prediction.bostan.dma import Sender
from rmw_manycore_py.prediction.bostan.events import Events
from rmw_manycore_py.prediction.bostan.memory import Memory, MemoryKind
from rmw_manycore_py.prediction.bostan.network import Link, Transmit
from rmw_manycore_py.prediction.bostan.packets import Packet, flits_of, payloads
from rmw_manycore_py.prediction.bostan.parameters import Parameters
from rmw_manycore_py.prediction.bostan.topology import Hop
from rmw_manycore_py.prediction.bostan.transfers import (
    FlowControl,
    Outcome,
    Transfer,
    check,
    windows,
)

INTERFACE = "interface"


@dataclass(frozen=True)
class Traffic:
    """What came of transfers that ran together."""

    outcomes: list[Outcome]
    peak_fifo_flits: float
    lost_flits: float
    link_flits: dict[Hop, float]

    @property
    def end(self) -> float:
        """The cycle in which the last byte of all was written."""
        return max(outcome.end for outcome in self.outcomes)

    @property
    def lost_packets(self) -> int:
        """Packets of all transfers that met a full FIFO."""
        return sum(outcome.lost for outcome in self.outcomes)


def run(
    transfers: Sequence[Transfer],
    parameters: Parameters,
    flow_control: FlowControl = "none",
    phase: float = 0.0,
) -> Traffic:
    """Run transfers that all start at cycle 0.

    :param phase: which part of a refresh interval of the DDR has passed at the start.
    :raises ManycoreError: for an impossible transfer, or more than the interfaces can have.
    """
    check(transfers)
    unlimited = [math.inf] * len(transfers)
    limits = windows(transfers, parameters) if flow_control == "credits" else unlimited
    chip = _Chip(parameters, phase)
    for transfer, limit in zip(transfers, limits, strict=True):
        chip.add(transfer, limit)
    return chip.finish()


@dataclass
class _Flow:
    """A transfer under way: packets not yet read from memory, and those that wait to be sent."""

    transfer: Transfer
    sender: Sender
    unread: deque[int]
    buffers: int
    credits: float
    ready: deque[Packet] = field(default_factory=deque)
    outcome: Outcome = field(default_factory=Outcome)


class _Chip:
    """Links and memories, made where a transfer meets them."""

    def __init__(self, parameters: Parameters, phase: float) -> None:
        self._parameters = parameters
        self._phase = phase
        self._events = Events()
        self._links: dict[Hop, Link] = {}
        self._memories: dict[tuple[str, MemoryKind], Memory] = {}
        self._flows: list[_Flow] = []

    def add(self, transfer: Transfer, credit_flits: float) -> None:
        """Have a transfer start at cycle 0."""
        memory = self._memory(transfer.route[0], transfer.source)
        sender = Sender(transfer.method, memory, self._parameters)
        unread = deque(payloads(transfer.size_bytes))
        self._flows.append(_Flow(transfer, sender, unread, sender.buffers, credit_flits))

    def finish(self) -> Traffic:
        """Handle everything, and return what came of it."""
        for number in range(len(self._flows)):
            self._read(number)
        self._events.run()
        fifos = [fifo for link in self._links.values() for fifo in link.fifos.values()]
        return Traffic(
            [flow.outcome for flow in self._flows],
            max(fifo.peak_flits for fifo in fifos if math.isfinite(fifo.capacity_flits)),
            sum(fifo.lost_flits for fifo in fifos),
            {ends: link.sent_flits for ends, link in self._links.items()},
        )

    def _memory(self, node: str, kind: MemoryKind) -> Memory:
        place = node if kind == "CC SMEM" else node[0]  # the nodes of an I/O subsystem share theirs
        if (place, kind) not in self._memories:
            self._memories[place, kind] = Memory(kind, self._parameters, self._phase)
        return self._memories[place, kind]

    def _read(self, number: int) -> None:
        """Have packets read from memory, into as many buffers as are free."""
        flow = self._flows[number]
        while flow.unread and flow.buffers:
            flow.buffers -= 1
            payload = flow.unread.popleft()
            flits = flits_of(payload, self._parameters.header_flits)
            ready = flow.sender.next_ready(self._events.now, payload)
            self._events.at(ready, self._be_ready, number, Packet(number, payload, flits))

    def _be_ready(self, number: int, packet: Packet) -> None:
        self._flows[number].ready.append(packet)
        self._inject(number)

    def _inject(self, number: int) -> None:
        """Send the packets that are ready, as far as the credits go."""
        flow = self._flows[number]
        while flow.ready and flow.credits >= flow.ready[0].flits:
            packet = flow.ready.popleft()
            flow.credits -= packet.flits
            flow.outcome.sent += 1
            packet.place = 1
            first = self._link(flow.transfer.route[0], flow.transfer.route[1])
            first.offer(f"{INTERFACE} {number}", packet)

    def _link(self, start: str, end: str) -> Link:
        if (start, end) not in self._links:
            transmit = self._to_memory(start) if end == INTERFACE else self._to_router(start, end)
            self._links[start, end] = Link(self._events, self._parameters.fifo_flits, transmit)
            self._links[start, end].on_sent = self._deliver if end == INTERFACE else self._sent
        return self._links[start, end]

    def _to_router(self, start: str, end: str) -> Transmit:
        def transmit(packet: Packet, now: float) -> float:
            route = self._flows[packet.flow].transfer.route
            place = packet.place + 1
            copy = Packet(packet.flow, packet.payload_bytes, packet.flits, place)
            following = self._link(end, route[place] if place < len(route) else INTERFACE)
            head = now + self._parameters.hop_cycles
            self._events.at(head, following.begin_arrival, start, copy)
            return now + packet.flits

        return transmit

    def _to_memory(self, node: str) -> Transmit:
        def transmit(packet: Packet, now: float) -> float:
            kind = self._flows[packet.flow].transfer.destination
            written = self._memory(node, kind).write(now, packet.payload_bytes)
            return max(now + packet.flits, written)

        return transmit

    def _sent(self, packet: Packet) -> None:
        """Free the buffer of a packet that left its interface."""
        if packet.place == 1:
            self._flows[packet.flow].buffers += 1
            self._read(packet.flow)

    def _deliver(self, packet: Packet) -> None:
        flow = self._flows[packet.flow]
        flow.credits += packet.flits
        if not packet.is_damaged:
            flow.outcome.delivered += 1
            flow.outcome.delivered_bytes += packet.payload_bytes
            flow.outcome.end = self._events.now
        self._inject(packet.flow)
