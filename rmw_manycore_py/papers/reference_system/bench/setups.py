# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Setups: contenders that alternate, and the figures of their runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, TUNED_FAST_DDS, Middleware
from rmw_manycore_py.papers.reference_system.bench.graph import (
    REAL_TIME,
    Member,
    in_one_cluster,
    in_real_time,
    members,
    with_hot_path_split,
)
from rmw_manycore_py.papers.reference_system.bench.kpis import Kpi, kpis, throughput
from rmw_manycore_py.papers.reference_system.bench.system import KEEP_ALL, Found, Load, Nodes
from rmw_manycore_py.process.scheduling import refusal

MESSAGES = {
    "4k": "Message4kb",
    "64k": "Message64kb",
    "256k": "Message256kb",
    "1m": "Message1024kb",
    "5m": "Message5120kb",
}
PAYLOADS = ("untouched", "checked")
OWN = replace(INSIDE, name="manycore")
OWN_IN_REAL_TIME = replace(INSIDE, name="manycore, real time")
OTHERS = (FAST_DDS, TUNED_FAST_DDS)
ONE_CLUSTER = "all in one cluster"
SPLIT = "hot path split over the clusters"
BESIDE_A_LOAD = "beside a load"
WITHOUT_PAUSE = "cycles 0"
MAPPED = "mappings"
REPORT_PERIOD_MS = 100
THROUGHPUT_S = 10.0


@dataclass(frozen=True)
class Wanted:
    """Options of `manycore bench reference`."""

    nodes: Nodes
    message: str
    crunch_ms: float
    duration_s: float

    def load(self, payload: str) -> Load:
        """Return the load of the nodes, with upstream's periods and depths."""
        return Load(
            f"manycore_reference_msgs/msg/{MESSAGES[self.message]}", payload, self.crunch_ms
        )


@dataclass(frozen=True)
class Contender:
    """A middleware, and the system mapped for it."""

    middleware: Middleware
    system: tuple[Member, ...]


@dataclass(frozen=True)
class Setup:
    """One table of figures."""

    name: str
    load: Load
    contenders: Mapping[str, Contender]
    figures: Callable[[Found], Sequence[Kpi]]
    duration_s: float
    is_beside_a_load: bool = False


def setups(wanted: Wanted) -> list[Setup]:
    """Return all setups, with an untouched and a checked payload."""
    system = members()
    return [
        setup
        for payload in PAYLOADS
        for setup in (
            _idle(wanted, system, payload),
            _beside_a_load(wanted, system, payload),
            _without_pause(wanted, system, payload),
            _mapped(wanted, system, payload),
        )
    ]


def _idle(wanted: Wanted, system: tuple[Member, ...], payload: str) -> Setup:
    contenders = _by_name(system, (OWN, *OTHERS))
    return Setup(payload, wanted.load(payload), contenders, kpis, wanted.duration_s)


def _beside_a_load(wanted: Wanted, system: tuple[Member, ...], payload: str) -> Setup:
    contenders = {**_by_name(system, (OWN, *OTHERS)), **_in_real_time(system)}
    name = f"{payload}, {BESIDE_A_LOAD}"
    return Setup(name, wanted.load(payload), contenders, kpis, wanted.duration_s, True)


def _without_pause(wanted: Wanted, system: tuple[Member, ...], payload: str) -> Setup:
    """Make sensors and planner publish continuously; the publishers block on slow readers."""
    unpaused = tuple(replace(member, period_ms=0) for member in system)
    load = replace(
        wanted.load(payload), crunch_ms=0.0, depth=KEEP_ALL, report_period_ms=REPORT_PERIOD_MS
    )
    name = f"{payload}, {WITHOUT_PAUSE}"
    duration_s = min(wanted.duration_s, THROUGHPUT_S)
    return Setup(name, load, _by_name(unpaused, (OWN, *OTHERS)), throughput, duration_s)


def _mapped(wanted: Wanted, system: tuple[Member, ...], payload: str) -> Setup:
    contenders = {
        OWN.name: Contender(OWN, system),
        **_in_real_time(system),
        ONE_CLUSTER: Contender(OWN, in_one_cluster(system)),
        SPLIT: Contender(OWN, with_hot_path_split(system)),
    }
    name = f"{payload}, {MAPPED}"
    return Setup(name, wanted.load(payload), contenders, kpis, wanted.duration_s)


def _by_name(system: tuple[Member, ...], middlewares: Sequence[Middleware]) -> dict[str, Contender]:
    return {middleware.name: Contender(middleware, system) for middleware in middlewares}


def _in_real_time(system: tuple[Member, ...]) -> dict[str, Contender]:
    """Return the system with real-time scheduling, if this user may set it."""
    if any(refusal(scheduling) for scheduling in REAL_TIME.values()):
        return {}
    return {OWN_IN_REAL_TIME.name: Contender(OWN_IN_REAL_TIME, in_real_time(system))}
