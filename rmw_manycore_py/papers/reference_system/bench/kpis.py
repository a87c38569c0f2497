# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Key figures of a run, those of the reference system and additional ones."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from rmw_manycore_py.papers.reference_system.bench.system import Found
from rmw_manycore_py.papers.reference_system.bench.text import Report, values
from rmw_manycore_py.papers.reference_system.sample_path import HOT_PATH_SINK, PLANNER

HOT_PATH_LATENCY = "hot path"
HOT_PATH_WORST = "hot path, worst"
HOT_PATH_RATE = "messages through the hot path"
HOT_PATH_DROPS = "hot path drops"
LOST = "lost messages"
PERIOD = f"{PLANNER} period"
PERIOD_SIGMA = f"{PLANNER} period, sigma"
CPU = "CPU of all nodes"
MEMORY = "memory per node, PSS"
RECEIVE_THREADS = "memory of all receive threads, PSS"
START = "start to the first output"
US_PER_MS = 1e3
NS_PER_S = 1e9
KIB = 1024


@dataclass(frozen=True)
class Kpi:
    """Samples of one figure in one run."""

    name: str
    unit: str
    samples: Sequence[float]
    higher_is_better: bool = False


def kpis(found: Found) -> list[Kpi]:
    """Return the figures of a run with upstream's periods, if enough was reported."""
    latencies = [ms * US_PER_MS for ms in values(found.reports, "hot path latency")]
    periods = values(found.reports, "behavior planner period")
    *nodes, receive_threads = found.pss_bytes
    figures = [
        Kpi(HOT_PATH_LATENCY, "us", latencies),
        Kpi(HOT_PATH_WORST, "us", latencies and [max(latencies)]),
        Kpi(HOT_PATH_RATE, "1/s", [_rate(found.reports)], higher_is_better=True),
        Kpi(HOT_PATH_DROPS, "count", [sum(values(found.reports, "hot path drops"))]),
        Kpi(LOST, "count", [lost(found)]),
        Kpi(PERIOD, "ms", periods),
        Kpi(PERIOD_SIGMA, "ms", [statistics.stdev(periods)] if len(periods) > 1 else []),
        Kpi(CPU, "ms/s", [found.cpu_ms_per_s]),
        Kpi(MEMORY, "KiB", [pss / KIB for pss in nodes]),
        Kpi(RECEIVE_THREADS, "KiB", [receive_threads / KIB]),
        Kpi(START, "ms", [found.start_ms]),
    ]
    return [figure for figure in figures if figure.samples]


def throughput(found: Found) -> list[Kpi]:
    """Return the figures of a run whose sensors publish continuously."""
    return [
        Kpi(HOT_PATH_RATE, "1/s", [_rate(found.reports)], higher_is_better=True),
        Kpi(LOST, "count", [lost(found)]),
    ]


def lost(found: Found) -> int:
    """Return the number of failed deliveries, over all topics."""
    return sum(loss.count for loss in found.losses)


def _rate(reports: Sequence[Report]) -> float:
    """Return the outputs per second of the hot path's last node, from its records."""
    seen = [report for report in reports if HOT_PATH_SINK in report.sequences]
    if len(seen) < 2:
        return 0.0
    first, last = seen[0], seen[-1]
    count = last.sequences[HOT_PATH_SINK] - first.sequences[HOT_PATH_SINK]
    return count * NS_PER_S / max(last.stamps_ns[HOT_PATH_SINK] - first.stamps_ns[HOT_PATH_SINK], 1)
