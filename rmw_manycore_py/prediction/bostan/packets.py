# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Packets: header flits, and at most 62 flits of payload."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.prediction.bostan.parameters import FLIT_BYTES, MAX_PAYLOAD_FLITS

MAX_PAYLOAD_BYTES = MAX_PAYLOAD_FLITS * FLIT_BYTES
# The SMEM of a cluster.
MAX_TRANSFER_BYTES = 2 * 1024 * 1024


@dataclass
class Packet:
    """A packet under way; `place` is the index of the node in the route that it goes to next."""

    flow: int
    payload_bytes: int
    flits: float
    place: int = 0
    kept_flits: float = 0.0  # of it, in the FIFO where it is
    is_damaged: bool = False
    has_arrived: bool = False  # with its last flit in the FIFO where it is


def payloads(size_bytes: int) -> list[int]:
    """Return the payload of each packet of a transfer.

    :raises ManycoreError: when there is nothing to transfer, or more than a memory holds.
    """
    if not 1 <= size_bytes <= MAX_TRANSFER_BYTES:
        message = f"a transfer of {size_bytes} bytes: expected 1 to {MAX_TRANSFER_BYTES}, one SMEM"
        raise ManycoreError(message, EXIT_BAD_INPUT)
    full, rest = divmod(size_bytes, MAX_PAYLOAD_BYTES)
    return [MAX_PAYLOAD_BYTES] * full + ([rest] if rest else [])


def flits_of(payload_bytes: int, header_flits: float) -> float:
    """Return the length of a packet."""
    return math.ceil(payload_bytes / FLIT_BYTES) + header_flits
