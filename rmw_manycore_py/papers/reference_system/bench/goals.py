# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Goals of rmw_manycore in the reference system."""

from __future__ import annotations

from rmw_manycore_py.bench.contenders import FAST_DDS, TUNED_FAST_DDS
from rmw_manycore_py.bench.summary import Goal
from rmw_manycore_py.papers.reference_system.bench import kpis
from rmw_manycore_py.papers.reference_system.bench.setups import (
    BESIDE_A_LOAD,
    OWN,
    OWN_IN_REAL_TIME,
    PAYLOADS,
    WITHOUT_PAUSE,
    Wanted,
)

LIDAR_HZ = 10


def question(figure: str, setup: str) -> str:
    """Return the name under which a figure of a setup is reported."""
    return f"{figure}, {setup}"


def goals(wanted: Wanted) -> tuple[Goal, ...]:
    """Return the goals that apply with these options.

    rclpy's overhead and the callbacks' work hide the middleware: with them, only losses and jitter
    are judged.
    """
    found = [goal for payload in PAYLOADS for goal in _always(payload)]
    if wanted.nodes == "rcl" and wanted.crunch_ms == 0:
        found += [goal for payload in PAYLOADS for goal in _of_the_middleware(wanted, payload)]
    return tuple(found)


def _always(payload: str) -> list[Goal]:
    beside = f"{payload}, {BESIDE_A_LOAD}"
    lost = [
        Goal(question(kpis.LOST, setup), OWN.name, "within", 0, None, "largest")
        for setup in (payload, beside, f"{payload}, {WITHOUT_PAUSE}")
    ]
    dropped = [
        Goal(question(kpis.HOT_PATH_DROPS, setup), OWN.name, "within", 0, None, "largest")
        for setup in (payload, beside)
    ]
    return [
        *lost,
        *dropped,
        *(
            Goal(question(kpis.HOT_PATH_RATE, setup), OWN.name, "better", LIDAR_HZ * 0.99)
            for setup in (payload, beside)
        ),
        Goal(question(kpis.PERIOD_SIGMA, payload), OWN.name, "within", 0.1),
        Goal(question(kpis.PERIOD_SIGMA, beside), OWN_IN_REAL_TIME.name, "within", 1.0),
    ]


def _of_the_middleware(wanted: Wanted, payload: str) -> list[Goal]:
    def better(figure: str, setup: str, factor: float, peer: str) -> Goal:
        return Goal(question(figure, setup), OWN.name, "better", factor, peer, "mean")

    def within(figure: str, factor: float) -> Goal:
        return Goal(question(figure, payload), OWN.name, "within", factor, FAST_DDS.name)

    latency = question(kpis.HOT_PATH_LATENCY, payload)
    of_size = {
        "4k": [
            better(kpis.HOT_PATH_LATENCY, payload, 1.8, FAST_DDS.name),
            Goal(latency, OWN.name, "better", 2.0, FAST_DDS.name, "p99"),
        ],
        "1m": [
            better(kpis.HOT_PATH_LATENCY, payload, 20.0, FAST_DDS.name),
            better(kpis.HOT_PATH_LATENCY, payload, 2.0, TUNED_FAST_DDS.name),
        ],
    }
    return [
        *of_size.get(wanted.message, []),
        better(kpis.HOT_PATH_RATE, f"{payload}, {WITHOUT_PAUSE}", 5.0, FAST_DDS.name),
        within(kpis.CPU, 0.6),
        within(kpis.START, 0.35),
    ]
