# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of the model: published ones are constants, unpublished ones have a range.

A relation that holds at both ends of every range follows from the structure of the chip; one that
holds for some values only depends on a number that is not known.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace

# Maruyama's thesis (Osaka University, 2018), sections 2.1.2 and 2.1.3.
LINK_BYTES_PER_CYCLE = 4
FLIT_BYTES = LINK_BYTES_PER_CYCLE
MAX_PAYLOAD_FLITS = 62
HEADER_FLITS = (1, 4)
NODE_CLOCK_HZ = 600e6
UC_PER_NODE = 8
RX_PER_NODE = 256
PE_CACHE_BYTES, PE_CACHE_WAYS = 8 * 1024, 2
IO_CACHE_BYTES, IO_CACHE_WAYS = 128 * 1024, 8
SMEM_BANKS = 16
# Hascoet and others, DOI 10.1145/3139315.3139318: what one-sided transfers reach on Bostan.
PUBLISHED_SHARE_OF_PEAK = 0.94
PUBLISHED_ROUND_TRIP_S = 2.2e-6
PUBLISHED_CLOCK_HZ = 500e6
# JEDEC JESD79-3 (DDR3): refresh interval, and duration of a refresh of a 4 Gb device.
REFRESH_INTERVAL_S = 7.8e-6
REFRESH_S = 260e-9
SMEM_BANK_BYTES_PER_CYCLE = 8
BYTES_PER_LOAD = 8  # the widest load of a core


def assumed(low: float, high: float, default: float | None = None) -> float:
    """Return a dataclass field for an unpublished number: its default is the range's middle.

    The middle is the geometric mean, so no default is chosen with a figure in mind; only what must
    be a power of two is given one.
    """
    middle = round(math.sqrt(low * high), 3)
    found: float = field(
        default=middle if default is None else default, metadata={"range": (low, high)}
    )
    return found


@dataclass(frozen=True)
class Parameters:
    """Unpublished numbers; durations in cycles of the chip's clock, sizes in the unit named."""

    clock_hz: float = NODE_CLOCK_HZ
    header_flits: float = assumed(*HEADER_FLITS)
    hop_cycles: float = assumed(2, 12)
    fifo_flits: float = assumed(128, 1024)
    # Fitted: a put of mppa_async takes half of the published round trip.
    tx_start_cycles: float = assumed(250, 1100)
    uc_start_cycles: float = assumed(250, 1100)
    uc_read_ahead_packets: float = assumed(2, 8)
    # A core that feeds Tx: a load and a store of 8 bytes, and the loop around them.
    tx_loop_cycles: float = assumed(2, 8)
    line_bytes: float = assumed(32, 64, default=64)
    cluster_smem_cycles: float = assumed(6, 16)
    io_smem_cycles: float = assumed(6, 32)
    ddr_cycles: float = assumed(30, 200)
    # 64 data lines, from DDR3-1066 at half of its peak to DDR3-1600 near its peak.
    ddr_bytes_per_s: float = assumed(4.3e9, 12e9)
    # Share of that rate for packets of 248 bytes that four DMA engines write in turns.
    ddr_scatter_share: float = assumed(0.25, 1)
    multiply_add_cycles: float = assumed(2, 8)

    @property
    def cycle_s(self) -> float:
        """The length of a cycle."""
        return 1 / self.clock_hz

    def cycles(self, seconds: float) -> float:
        """Convert seconds to cycles."""
        return seconds * self.clock_hz


def corners(parameters: Parameters, names: tuple[str, ...]) -> Iterator[Parameters]:
    """Yield the parameters with every combination of the ends of the named ranges."""
    if not names:
        yield parameters
        return
    name, *rest = names
    for end in range_of(name):
        yield from corners(replace(parameters, **{name: end}), tuple(rest))


def range_of(name: str) -> tuple[float, float]:
    """Return the ends of a range."""
    (found,) = (f.metadata["range"] for f in fields(Parameters) if f.name == name)
    low, high = found
    return low, high
