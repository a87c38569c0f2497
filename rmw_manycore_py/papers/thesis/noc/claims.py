# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Claims of section 4.1.2 of the thesis about its figures, as functions of times."""

from __future__ import annotations

from typing import Protocol

from rmw_manycore_py.bench.relations import Claim, Found, side
from rmw_manycore_py.papers.thesis.noc.cases import (
    FLOW_CONTROL,
    NO_FLOW_CONTROL,
    Case,
    Setting,
    size_name,
)
from rmw_manycore_py.prediction.bostan.dma import METHODS, Method
from rmw_manycore_py.prediction.bostan.memory import MEMORIES, MemoryKind

# Two times are alike up to this ratio.
ALIKE = 1.1
FASTER = 1.02
LINEAR = 1.25
TWICE = (1.6, 2.5)
LARGE_BYTES = 10_000


class Times(Protocol):
    """Median times of transfers in us, and losses; KeyError for what was not measured."""

    @property
    def setting(self) -> Setting:
        """The routes."""

    @property
    def sizes(self) -> tuple[int, ...]:
        """The sizes in bytes, smallest first."""

    def us(self, case: Case, size_bytes: int) -> float:
        """Return the time of a transfer."""

    def lost(self, flow_control: str) -> float:
        """Return the loss while four clusters write to the DDR."""


def _main(times: Times, method: Method, source: MemoryKind) -> Case:
    setting = times.setting
    return Case(method, source, setting.between if source == "CC SMEM" else setting.main)


def _large(times: Times) -> list[int]:
    """Return the sizes whose time is that of the data rather than of the start."""
    found = [size for size in times.sizes if size >= LARGE_BYTES]
    if not found:
        raise KeyError("large transfers")
    return found


def linear(times: Times) -> Found:
    """T1: each time is near the line through those of the smallest and the largest transfer."""
    if len(times.sizes) < 3:
        raise KeyError("three sizes")
    smallest, *between, largest = times.sizes
    worst = 1.0
    for case in (_main(times, method, source) for method in METHODS for source in MEMORIES):
        start, end = times.us(case, smallest), times.us(case, largest)
        for size in between:
            on_line = start + (end - start) * (size - smallest) / (largest - smallest)
            worst = max(worst, _ratio(times.us(case, size), on_line))
    return side(worst, max_value=LINEAR), f"off the line by at most x {worst:.2f}"


def routes_alike(times: Times) -> Found:
    """T2: the slowest route takes little longer than the fastest."""
    if len(times.setting.routes) < 2:
        raise KeyError("two routes")
    worst, where = 1.0, ""
    for method in METHODS:
        for source in ("IO DDR", "IO SMEM"):
            for size in times.sizes:
                cases = [Case(method, source, route) for route in times.setting.routes]
                found = [times.us(case, size) for case in cases]
                if max(found) / min(found) > worst:
                    worst = max(found) / min(found)
                    where = f" ({method}, {source}, {size_name(size)})"
    return side(worst, max_value=ALIKE), f"slowest route / fastest at most {worst:.2f}{where}"


def uc_faster(times: Times) -> Found:
    """T3: the UC beats Tx wherever the data, not the start, takes the time."""
    ratios = [
        times.us(_main(times, "Tx", source), size) / times.us(_main(times, "UC", source), size)
        for source in MEMORIES
        for size in _large(times)
    ]
    return side(
        min(ratios), min_value=ALIKE
    ), f"Tx / UC {min(ratios):.2f} to {max(ratios):.2f} from 10 KB"


def tx_from_ddr_twice(times: Times) -> Found:
    """T4: Tx takes twice as long from DDR as from the SMEM of the same I/O subsystem."""
    ratio = _ddr_to_smem(times, "Tx", times.sizes[-1])
    return side(
        ratio, min_value=TWICE[0], max_value=TWICE[1]
    ), f"DDR / IO SMEM {ratio:.2f}, largest size"


def uc_indifferent(times: Times) -> Found:
    """T5: with the UC it does not matter whether data comes from DDR or SMEM."""
    ratios = [_ddr_to_smem(times, "UC", size) for size in _large(times)]
    return side(
        max(ratios), max_value=ALIKE
    ), f"DDR / IO SMEM {min(ratios):.2f} to {max(ratios):.2f} from 10 KB"


def _ddr_to_smem(times: Times, method: Method, size: int) -> float:
    ddr, smem = (times.us(_main(times, method, s), size) for s in ("IO DDR", "IO SMEM"))
    return ddr / smem


def between_clusters_faster(times: Times) -> Found:
    """T6: a transfer between clusters beats one from an I/O cluster, by either method."""
    ratios = [
        times.us(_main(times, method, "IO SMEM"), size)
        / times.us(_main(times, method, "CC SMEM"), size)
        for method in METHODS
        for size in _large(times)
    ]
    return side(
        min(ratios), min_value=FASTER
    ), f"IO-CC / CC-CC {min(ratios):.2f} to {max(ratios):.2f} from 10 KB"


def overflow(times: Times) -> Found:
    """T7: without flow control FIFOs overflow, with it they do not."""
    free, controlled = times.lost(NO_FLOW_CONTROL), times.lost(FLOW_CONTROL)
    found = f"{free:g} lost without flow control, {controlled:g} with credits"
    return (1 if controlled else side(free, min_value=1)), found


def _ratio(one: float, other: float) -> float:
    return max(one / other, other / one)


_START = ("tx_start_cycles", "uc_start_cycles")
_DDR_BY_UC = ("uc_read_ahead_packets", "ddr_cycles")
_SMEMS = ("io_smem_cycles", "cluster_smem_cycles")
_WRITES = ("ddr_bytes_per_s", "ddr_scatter_share")
_TX_COPY = ("tx_loop_cycles", "line_bytes")

CLAIMS: tuple[Claim[Times], ...] = (
    Claim(
        "T1",
        "time is linear in the size",
        linear,
        (*_START, *_DDR_BY_UC, "tx_loop_cycles", "header_flits", "hop_cycles"),
    ),
    Claim(
        "T2",
        "routes do not matter on an idle NoC",
        routes_alike,
        (*_START, *_DDR_BY_UC, "hop_cycles"),
    ),
    Claim(
        "T3",
        "UC is faster than Tx",
        uc_faster,
        (*_START, *_DDR_BY_UC, *_TX_COPY, "cluster_smem_cycles", "header_flits"),
    ),
    Claim(
        "T4",
        "Tx from DDR takes twice as long as from IO SMEM",
        tx_from_ddr_twice,
        (*_TX_COPY, "io_smem_cycles", "ddr_cycles"),
    ),
    Claim(
        "T5",
        "UC takes as long from DDR as from SMEM",
        uc_indifferent,
        (*_DDR_BY_UC, "uc_start_cycles", "io_smem_cycles", "ddr_bytes_per_s"),
    ),
    Claim(
        "T6",
        "CC to CC is faster than I/O to CC",
        between_clusters_faster,
        (*_TX_COPY, *_SMEMS, "uc_read_ahead_packets"),
    ),
    Claim(
        "T7",
        "four clusters that write to DDR overflow router FIFOs",
        overflow,
        (*_WRITES, "fifo_flits", "header_flits", "uc_read_ahead_packets"),
    ),
)
