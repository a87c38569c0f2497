# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a packet's payload gets out of a memory: word by word through a core, or by the UC.

*Tx*: a core loads 8 bytes, stores them into the packet buffer of the interface, and waits for its
memory at every cache line. *UC*: the DMA engine reads ahead on its own, so it waits for the rate
of the memory, and for its latency only as far as it does not read ahead.
"""

from __future__ import annotations

import math
from typing import Literal

from rmw_manycore_py.prediction.bostan.memory import Memory
from rmw_manycore_py.prediction.bostan.parameters import BYTES_PER_LOAD, Parameters

Method = Literal["Tx", "UC"]
METHODS: tuple[Method, ...] = ("Tx", "UC")
TX_BUFFERS = 2  # one is filled while the other is sent


class Sender:
    """The sending side of one transfer."""

    def __init__(self, method: Method, memory: Memory, parameters: Parameters) -> None:
        self._is_uc = method == "UC"
        self._memory = memory
        self._parameters = parameters
        self._ready = parameters.uc_start_cycles if self._is_uc else parameters.tx_start_cycles

    @property
    def buffers(self) -> int:
        """How many packets it reads ahead of the one that the link sends."""
        return round(self._parameters.uc_read_ahead_packets) if self._is_uc else TX_BUFFERS

    def next_ready(self, now: float, payload_bytes: int) -> float:
        """Return when the payload of the next packet is in the interface, which has room now."""
        start = max(now, self._ready)
        if self._is_uc:
            return self._memory.read(start, payload_bytes)
        self._ready = start + self._core_cycles(payload_bytes)
        return self._ready

    def _core_cycles(self, payload_bytes: int) -> float:
        line_bytes = self._parameters.line_bytes
        words = math.ceil(payload_bytes / BYTES_PER_LOAD)
        waits = payload_bytes / line_bytes * self._memory.line_load_cycles(line_bytes)
        return words * self._parameters.tx_loop_cycles + waits
