# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A router's FIFO: what comes in from one direction and waits for the link of another.

Its fill is exact without an event per flit: flits come at one per cycle and leave at a steady rate,
so between two events the fill changes linearly and is largest at one of them.
"""

from __future__ import annotations

from collections import deque

from rmw_manycore_py.prediction.bostan.packets import Packet


class Fifo:
    """One input, one output; flits beyond the capacity are lost, and their packet with them."""

    def __init__(self, capacity_flits: float) -> None:
        self.capacity_flits = capacity_flits
        self.peak_flits = 0.0
        self.lost_flits = 0.0
        self.packets: deque[Packet] = deque()
        self._fill = 0.0
        self._arriving: Packet | None = None
        self._leaving_rate = 0.0
        self._updated = 0.0

    def put(self, packet: Packet) -> None:
        """Take a whole packet at once; for the buffers of an interface, which have no limit."""
        packet.has_arrived = True
        self.packets.append(packet)

    def begin_arrival(self, now: float, packet: Packet) -> None:
        """Take the first flit of a packet."""
        self._update(now)
        packet.has_arrived = False
        packet.kept_flits = packet.flits
        self.packets.append(packet)
        self._arriving = packet

    def end_arrival(self, now: float, packet: Packet) -> None:
        """Take the last flit of a packet."""
        self._update(now)
        packet.has_arrived = True
        if self._arriving is packet:  # else the next one began in this cycle
            self._arriving = None

    def begin_departure(self, now: float, packet: Packet, duration: float) -> None:
        """Send the packet in front, flit after flit, for `duration` cycles."""
        self._update(now)
        self._leaving_rate = packet.flits / duration

    def end_departure(self, now: float) -> Packet:
        """Remove the packet that was sent."""
        self._update(now)
        self._leaving_rate = 0.0
        return self.packets.popleft()

    def front(self, now: float) -> Packet | None:
        """Return the packet to send next; damaged ones are dropped once they are in whole."""
        self._update(now)
        while self.packets and self.packets[0].is_damaged and self.packets[0].has_arrived:
            self._fill = max(self._fill - self.packets.popleft().kept_flits, 0.0)
        if not self.packets or self.packets[0].is_damaged:
            return None
        return self.packets[0]

    def _update(self, now: float) -> None:
        rate = (1.0 if self._arriving else 0.0) - self._leaving_rate
        self._fill = max(self._fill + rate * (now - self._updated), 0.0)
        self._updated = now
        excess = self._fill - self.capacity_flits
        if excess > 1e-9 and self._arriving:
            self.lost_flits += excess
            self._arriving.is_damaged = True
            self._arriving.kept_flits -= excess
            self._fill = self.capacity_flits
        self.peak_flits = max(self.peak_flits, self._fill)
