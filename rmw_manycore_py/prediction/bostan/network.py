# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Routers and links: packets go through FIFOs from link to link, the head before the tail is there.

```
  interface ─► link C6→C2 ── FIFO ─┐
               link C1→C2 ── FIFO ─┴► link C2→N1 ── FIFO ─► interface: writes to memory
```

A router has a FIFO per input in front of each of its links, and a link takes packets from them in
turns. Routers do not hold packets back: what a full FIFO is sent is lost.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from rmw_manycore_py.prediction.bostan.events import Events
from rmw_manycore_py.prediction.bostan.fifo import Fifo
from rmw_manycore_py.prediction.bostan.packets import Packet

Transmit = Callable[[Packet, float], float]


class Link:
    """One direction of a link, or the way from the last router into a memory."""

    def __init__(self, events: Events, fifo_flits: float, transmit: Transmit) -> None:
        """`transmit` sends a packet on at a time, and returns when its last flit has left."""
        self._events = events
        self._fifo_flits = fifo_flits
        self._transmit = transmit
        self._is_busy = False
        self._turn = 0
        self._inputs: list[str] = []
        self.fifos: dict[str, Fifo] = {}
        self.sent_flits = 0.0
        self.on_sent: Callable[[Packet], None] = lambda _: None

    def offer(self, source: str, packet: Packet) -> None:
        """Take a whole packet from the buffer of an interface."""
        self._fifo(source, math.inf).put(packet)
        self._serve()

    def begin_arrival(self, source: str, packet: Packet) -> None:
        """Take the first flit of a packet from a router; the others follow at one per cycle."""
        fifo = self._fifo(source, self._fifo_flits)
        now = self._events.now
        fifo.begin_arrival(now, packet)
        self._events.at(now + packet.flits, self._end_arrival, fifo, packet)
        self._serve()

    def _fifo(self, source: str, capacity_flits: float) -> Fifo:
        fifo = self.fifos.get(source)
        if fifo is None:
            fifo = self.fifos[source] = Fifo(capacity_flits)
            self._inputs.append(source)
        return fifo

    def _end_arrival(self, fifo: Fifo, packet: Packet) -> None:
        fifo.end_arrival(self._events.now, packet)
        self._serve()

    def _serve(self) -> None:
        if self._is_busy:
            return
        now, count = self._events.now, len(self._inputs)
        for turn in range(self._turn, self._turn + count):
            fifo = self.fifos[self._inputs[turn % count]]
            packet = fifo.front(now)
            if packet is not None:
                self._turn = (turn + 1) % count
                self._is_busy = True
                end = self._transmit(packet, now)
                fifo.begin_departure(now, packet, end - now)
                self._events.at(end, self._end_departure, fifo)
                return

    def _end_departure(self, fifo: Fifo) -> None:
        packet = fifo.end_departure(self._events.now)
        self.sent_flits += packet.flits
        self._is_busy = False
        self.on_sent(packet)
        self._serve()
