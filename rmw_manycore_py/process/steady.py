# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The steady clock: that of the kernel, or in a run in virtual time the virtual one."""

from __future__ import annotations

from rmw_manycore_py.native._transport import now_ns


def steady_s() -> float:
    """Return the time in seconds; as time.monotonic(), but also virtual."""
    return now_ns() / 1e9
