# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How the messages of topics reach other clusters, as people read it."""

from __future__ import annotations

from rmw_manycore_py.native.enums import Transfer


def transfer_text(transfer: Transfer, priority: int, synchronous: bool) -> str:
    """Return a transfer with what belongs to it."""
    if transfer != "message":
        return transfer
    return f"message, priority {priority}{', synchronous' if synchronous else ''}"
