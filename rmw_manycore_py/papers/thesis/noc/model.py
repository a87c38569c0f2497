# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transfers in the model of Bostan: samples for figures, and times for every setting.

Nothing in the model is random. What differs between runs is where in a refresh interval of the DDR
they start, so transfers from SMEM take the same time in all runs.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from functools import cache

from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.relations import Claim, Found, Relation, Side, modelled_relations, side
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.thesis.noc.cases import OVERFLOW, RUNS, Case, Setting, question_of
from rmw_manycore_py.papers.thesis.noc.claims import CLAIMS
from rmw_manycore_py.papers.thesis.noc.figures import Draw
from rmw_manycore_py.prediction.bostan import routing
from rmw_manycore_py.prediction.bostan.chip import run as run_chip
from rmw_manycore_py.prediction.bostan.dma import Method
from rmw_manycore_py.prediction.bostan.memory import MemoryKind
from rmw_manycore_py.prediction.bostan.parameters import (
    LINK_BYTES_PER_CYCLE,
    PUBLISHED_CLOCK_HZ,
    PUBLISHED_ROUND_TRIP_S,
    PUBLISHED_SHARE_OF_PEAK,
    Parameters,
    corners,
)
from rmw_manycore_py.prediction.bostan.routing import Route
from rmw_manycore_py.prediction.bostan.transfers import FLOW_CONTROLS, Transfer

DIRECT, CROSS, DETOUR, BETWEEN = "direct", "cross", "detour", "cluster to cluster"
SETTING = Setting((DIRECT, CROSS, DETOUR), CROSS, BETWEEN)
# The shapes of Fig. 4.1: one link, one corner, and a long way round, all from the north.
ROUTES: dict[str, Route] = {
    DIRECT: routing.shortest("N0", "C1"),
    CROSS: routing.shortest("N1", "C5"),
    DETOUR: routing.checked(("N0", "C1", "C2", "C3", "C4", "C8", "C7", "C6", "C5")),
    BETWEEN: routing.shortest("C1", "C6"),
}
OVERFLOW_BYTES = 20_000
PHASES = 50  # of a refresh interval
_SEED = 1
_OF_METHOD: dict[Method, tuple[str, ...]] = {
    "Tx": ("tx_start_cycles", "tx_loop_cycles", "line_bytes"),
    "UC": ("uc_start_cycles", "uc_read_ahead_packets"),
}
_OF_SOURCE: dict[MemoryKind, tuple[str, ...]] = {
    "IO DDR": ("ddr_cycles", "ddr_bytes_per_s"),
    "IO SMEM": ("io_smem_cycles",),
    "CC SMEM": ("cluster_smem_cycles",),
}
# In other settings than the default: larger transfers only repeat what these do.
SETTING_BYTES = 100_000
# A put of the published round trip carries a word.
PING_BYTES = 8
WITHIN = 0.1


@dataclass(frozen=True)
class ModelTimes:
    """Times in the model with some parameters; each is computed when it is asked for."""

    sizes: tuple[int, ...]
    parameters: Parameters
    setting: Setting = SETTING

    def us(self, case: Case, size_bytes: int) -> float:
        """Return the time of a transfer, started just after a refresh."""
        return _us(case, size_bytes, relevant(case, self.parameters), 0.5 / PHASES)

    def lost(self, flow_control: str) -> float:
        """Return the packets lost while four clusters write to the DDR, each by its own link."""
        return _lost(flow_control, self.parameters)


def relevant(case: Case, parameters: Parameters) -> Parameters:
    """Return the parameters with those as by default that the time of a transfer is free of.

    Settings that differ in nothing else share a simulation then.
    """
    names = ["clock_hz", "header_flits", "hop_cycles", *_OF_METHOD[case.method]]
    names += _OF_SOURCE[case.source]
    return Parameters(**{name: getattr(parameters, name) for name in names})


@cache
def _us(case: Case, size_bytes: int, parameters: Parameters, phase: float) -> float:
    transfer = Transfer(ROUTES[case.route], size_bytes, case.method, case.source)
    return run_chip([transfer], parameters, phase=phase).end * parameters.cycle_s * 1e6


@cache
def _lost(flow_control: str, parameters: Parameters) -> float:
    transfers = [
        Transfer(
            routing.shortest(f"C{number + 1}", f"N{number}"),
            *(OVERFLOW_BYTES, "UC", "CC SMEM", "IO DDR"),
        )
        for number in range(4)
    ]
    return run_chip(transfers, parameters, FLOW_CONTROLS[flow_control]).lost_packets


def share_of_peak(times: ModelTimes) -> Found:
    """Compare the throughput of large transfers, without their start, with that of puts."""
    if len(times.sizes) < 2:
        raise KeyError("two sizes")
    smaller, larger = times.sizes[-2:]
    case = Case("UC", "CC SMEM", BETWEEN)
    us = times.us(case, larger) - times.us(case, smaller)
    peak = times.parameters.clock_hz * LINK_BYTES_PER_CYCLE
    share = (larger - smaller) / (us * 1e-6 * peak)
    return _near(
        share / PUBLISHED_SHARE_OF_PEAK
    ), f"{share:.1%} of the link's peak, published {PUBLISHED_SHARE_OF_PEAK:.0%}"


def round_trip(times: ModelTimes) -> Found:
    """Compare two puts of a word with the published round trip, at its clock rate."""
    us = times.us(Case("UC", "CC SMEM", BETWEEN), PING_BYTES)
    seconds = 2 * us * 1e-6 * times.parameters.clock_hz / PUBLISHED_CLOCK_HZ
    published = f"published {PUBLISHED_ROUND_TRIP_S * 1e6:.1f}"
    return (
        _near(seconds / PUBLISHED_ROUND_TRIP_S),
        f"{seconds * 1e6:.2f} us at 500 MHz, {published}",
    )


def _near(ratio: float) -> Side:
    return side(ratio, min_value=1 - WITHIN, max_value=1 + WITHIN)


_UC = ("header_flits", "hop_cycles", "uc_start_cycles", "cluster_smem_cycles")
PUBLISHED: tuple[Claim[ModelTimes], ...] = (
    Claim("P1", "94 % of the peak, within 10 %", share_of_peak, (*_UC, "uc_read_ahead_packets")),
    Claim("P2", "2.2 us round trip, within 10 %", round_trip, _UC),
)


def question(sizes: tuple[int, ...], draw: Draw) -> Question:
    """Return the question as it is put to the model."""

    def measure(run: Run) -> list[Result]:
        return [*_samples(run, sizes), *_overflow(run)]

    def relations(_: object) -> list[Relation]:
        return _relations(sizes)

    return Question("noc, model of Bostan", measure, (), "none: simulated", relations, draw)


def _samples(run: Run, sizes: tuple[int, ...]) -> list[Result]:
    draw = random.Random(_SEED)
    phases = [draw.randrange(PHASES) / PHASES for _ in range(run.rounds * run.iterations(RUNS))]
    results = []
    for size in sizes:
        for case in SETTING.cases:
            name = f"{question_of(size)}: {case.name}"
            if run.wants(name):
                run.note(name)
                needed = phases if case.source == "IO DDR" else [0.0] * len(phases)
                samples = tuple(_us(case, size, Parameters(), phase) for phase in needed)
                results.append(Result(question_of(size), case.name, "us", samples))
    return results


def _overflow(run: Run) -> list[Result]:
    wanted = [name for name in FLOW_CONTROLS if run.wants(f"{OVERFLOW}: {name}")]
    return [Result(OVERFLOW, name, "packets", (_lost(name, Parameters()),)) for name in wanted]


def _relations(sizes: tuple[int, ...]) -> list[Relation]:
    default = ModelTimes(sizes, Parameters())
    small = tuple(size for size in sizes if size <= SETTING_BYTES) or sizes[:1]

    def at_corners(names: tuple[str, ...]) -> list[ModelTimes]:
        return [ModelTimes(small, p) for p in corners(Parameters(), names)]

    return [
        *modelled_relations(CLAIMS, default, at_corners),
        *modelled_relations(PUBLISHED, default, at_corners),
    ]
