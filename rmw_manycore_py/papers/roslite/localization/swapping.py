# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Swapping: tiles are copied from the DRAM of the I/O cluster into a bounded part of SMEM."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.papers.roslite.localization.tiles import TileKey


@dataclass(frozen=True)
class Pooled:
    """A tile in the pool: the file in which its owner shares it, and its bytes."""

    path: str
    size_bytes: int


class SwappedTiles:
    """The tiles in SMEM: those used last, as many as fit.

    :param pool: all tiles of the map.
    :param room_bytes: how much SMEM they may take.
    :param charge: called with what they take from now on, before a tile comes; raises
        ManycoreError if the cluster has no room.
    :raises ManycoreError: if a tile does not fit at all.
    """

    def __init__(
        self, pool: Mapping[TileKey, Pooled], room_bytes: int, charge: Callable[[int], None]
    ) -> None:
        for key, pooled in pool.items():
            if pooled.size_bytes > room_bytes:
                raise ManycoreError(
                    f"tile {key.column} {key.row} of the map: expected at most smem_bytes = "
                    f"{room_bytes}, found {pooled.size_bytes}; use smaller tiles"
                )
        self._pool = pool
        self._room_bytes = room_bytes
        self._charge = charge
        self._held: OrderedDict[TileKey, _ndt.VoxelMap] = OrderedDict()
        self.swaps = 0  # tiles copied so far

    @property
    def held(self) -> tuple[TileKey, ...]:
        """The tiles in SMEM, the one used last at the end."""
        return tuple(self._held)

    def visit(self, wanted: Iterable[TileKey]) -> Iterator[tuple[TileKey, _ndt.VoxelMap]]:
        """Yield those of the tiles that the map has; first those in SMEM, before others come."""
        known = [key for key in wanted if key in self._pool]
        for key in sorted(known, key=lambda key: key not in self._held):
            yield key, self._brought(key)

    def _brought(self, key: TileKey) -> _ndt.VoxelMap:
        if key not in self._held:
            needed = self._pool[key].size_bytes
            while self._bytes + needed > self._room_bytes:
                self._held.popitem(last=False)
            self._charge_with(needed)
            self._held[key] = copied(self._pool[key])
            self.swaps += 1
        self._held.move_to_end(key)
        return self._held[key]

    def _charge_with(self, needed: int) -> None:
        """Charge a further tile, in place of others where the cluster has no room for all."""
        while True:
            try:
                return self._charge(self._bytes + needed)
            except ManycoreError:
                if not self._held:
                    raise
                self._held.popitem(last=False)

    @property
    def _bytes(self) -> int:
        return sum(self._pool[key].size_bytes for key in self._held)


def copied(pooled: Pooled) -> _ndt.VoxelMap:
    """Return a tile of the pool in memory of this process.

    :raises ManycoreError: if its owner is gone.
    """
    memory = os.memfd_create("ros-lite-tile", os.MFD_CLOEXEC)
    try:
        os.write(memory, Path(pooled.path).read_bytes())
        with translate_native_errors("a tile of the map"):
            return _ndt.VoxelMap.attach(f"/proc/self/fd/{memory}")
    except OSError as error:
        raise ManycoreError(f"a tile of the map: {error}; is lidar_localizer running?") from error
    finally:
        os.close(memory)
