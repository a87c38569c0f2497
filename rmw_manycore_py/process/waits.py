# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How long a selector may wait."""

from __future__ import annotations

import math
import time

_MAX_WAIT_S = 86_400.0  # epoll takes at most 2^31 ms, which are 24.8 days


def wait_until_s(due_s: float) -> float | None:
    """Return the seconds until a time of CLOCK_MONOTONIC, at most a day; None for infinity."""
    if due_s == math.inf:
        return None
    return min(max(due_s - time.monotonic(), 0.0), _MAX_WAIT_S)
