# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A set-associative data cache that evicts the line that was used longest ago."""

from __future__ import annotations

from collections import OrderedDict


class Cache:
    """Counts hits and misses of addresses; holds no data."""

    def __init__(self, size_bytes: int, ways: int, line_bytes: int) -> None:
        self._line_bytes = line_bytes
        self._ways = ways
        self._sets: list[OrderedDict[int, None]] = [
            OrderedDict() for _ in range(size_bytes // ways // line_bytes)
        ]
        self.misses = 0

    def load(self, address: int) -> None:
        """Load from an address."""
        line = address // self._line_bytes
        lines = self._sets[line % len(self._sets)]
        if line in lines:
            lines.move_to_end(line)
            return
        self.misses += 1
        if len(lines) == self._ways:
            lines.popitem(last=False)
        lines[line] = None
