# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Layout of `data`: [0] the result of the callback's work, [1] a checksum, then the payload."""

from __future__ import annotations

from typing import Any

import numpy as np

RESULT, CHECKSUM, WORDS = 0, 1, 2


def write_payload(message: Any, sequence: int) -> None:
    """Fill the payload with consecutive numbers from `sequence`, and store their sum."""
    words = message.data[WORDS:]
    words[:] = np.arange(sequence, sequence + len(words))
    message.data[CHECKSUM] = words.sum()


def check_payload(message: Any, topic: str) -> None:
    """Raise RuntimeError unless the checksum matches."""
    total = message.data[WORDS:].sum()
    if total != message.data[CHECKSUM]:
        expected = message.data[CHECKSUM]
        raise RuntimeError(f"{topic}: expected a payload with the sum {expected}, found {total}")
