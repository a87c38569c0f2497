# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wake-up of a `select` from other threads."""

from __future__ import annotations

import os


class Alarm:
    """File descriptor that becomes readable once rung."""

    def __init__(self) -> None:
        self._descriptor = os.eventfd(0)

    def fileno(self) -> int:
        """Return the descriptor, for selectors."""
        return self._descriptor

    def ring(self) -> None:
        """Make it readable. Thread-safe."""
        os.eventfd_write(self._descriptor, 1)

    def close(self) -> None:
        """Close it; no thread may ring it afterwards."""
        os.close(self._descriptor)
