# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Colour map from blue over green to red, as Autoware uses for scores and steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def colors(shares: ArrayLike) -> NDArray[np.float64]:
    """Return red, green and blue (N, 3), 0 to 1, for shares (N), clipped to 0..1."""
    quarter, part = np.divmod(4.0 * np.clip(shares, 0.0, 0.9999), 1.0)
    rising, falling = np.sin(0.5 * np.pi * part), np.cos(0.5 * np.pi * part)
    none, full = np.zeros_like(part), np.ones_like(part)
    red = np.choose(quarter.astype(int), [none, none, rising, full])
    green = np.choose(quarter.astype(int), [rising, full, full, falling])
    blue = np.choose(quarter.astype(int), [full, falling, none, none])
    return np.stack([red, green, blue], axis=-1)


def packed_colors(shares: ArrayLike) -> NDArray[np.float32]:
    """Return colours (N) packed as in PCL: 0x00RRGGBB in the bits of a float."""
    red, green, blue = (255.0 * colors(shares)).astype(np.uint32).T
    packed: NDArray[np.uint32] = (red << 16) | (green << 8) | blue
    return packed.view(np.float32)
