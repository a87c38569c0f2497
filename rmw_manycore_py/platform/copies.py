# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How often an endpoint copies a large message."""

from __future__ import annotations

# Smaller messages are always copied; min_chunk_message_bytes in chunk_layout.hpp.
LARGE_BYTES = 64 << 10


def copies_per_message(messages: int, size_bytes: int, in_place: int) -> float | None:
    """Return the copies that an endpoint makes of a message: 0 to 1.

    Of a publisher from its program into shared memory, of a subscription from there. None unless
    messages have `LARGE_BYTES` on average.

    :param size_bytes: of all `messages` together.
    :param in_place: messages that were not copied.
    """
    if messages <= 0 or size_bytes < messages * LARGE_BYTES:
        return None
    return max(messages - in_place, 0) / messages
