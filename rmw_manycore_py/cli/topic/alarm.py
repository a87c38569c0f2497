# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What other threads end a `select` with."""

from __future__ import annotations

import os


class Alarm:
    """Readable once it has been rung."""

    def __init__(self) -> None:
        self._descriptor = os.eventfd(0)

    def fileno(self) -> int:
        """Return the descriptor, for selectors."""
        return self._descriptor

    def ring(self) -> None:
        """Make it readable. Any thread."""
        os.eventfd_write(self._descriptor, 1)

    def close(self) -> None:
        """Close it; no thread rings it any more."""
        os.close(self._descriptor)
