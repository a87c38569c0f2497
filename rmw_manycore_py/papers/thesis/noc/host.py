# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transfers on this machine: copies between segments, an eMCOS message, and a topic DSM.

| the thesis | here |
|---|---|
| Tx | the sender's core copies |
| UC | a process on another core copies at the sender's request |
| IO DDR | a buffer that was flushed from all caches |
| IO SMEM, CC SMEM | a buffer that the sender has just written |
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from rmw_manycore_py.bench.contenders import BETWEEN
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.relations import Relation, measured_relations
from rmw_manycore_py.bench.session import Session, run_program
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.thesis.noc.cases import (
    FLOW_CONTROL,
    NO_FLOW_CONTROL,
    OVERFLOW,
    RUNS,
    Case,
    Setting,
    question_of,
)
from rmw_manycore_py.papers.thesis.noc.claims import CLAIMS
from rmw_manycore_py.papers.thesis.noc.figures import Draw
from rmw_manycore_py.papers.thesis.noc.routes import Placement, main_route

WARM_UP = 20
BETWEEN_CLUSTERS = "cluster to cluster"
MESSAGE, TOPIC_DSM = "message (pipe) from IO SMEM", "topic DSM, half a round trip"
OVERFLOW_MESSAGES = 5000
_CONTROLS = {NO_FLOW_CONTROL: 0, FLOW_CONTROL: 1}


def setting_of(placements: Mapping[str, Placement]) -> Setting:
    """Return the routes of the machine; between clusters it is the main one."""
    return Setting(tuple(placements), main_route(placements), BETWEEN_CLUSTERS)


@dataclass(frozen=True)
class _MeasuredTimes:
    setting: Setting
    sizes: tuple[int, ...]
    medians: Mapping[tuple[str, str], float]

    def us(self, case: Case, size_bytes: int) -> float:
        return self.medians[question_of(size_bytes), case.name]

    def lost(self, flow_control: str) -> float:
        return self.medians[OVERFLOW, flow_control]


def question(sizes: tuple[int, ...], placements: Mapping[str, Placement], draw: Draw) -> Question:
    """Return the question as it is put to this machine."""
    setting = setting_of(placements)

    def measure(run: Run) -> list[Result]:
        results = []
        for size in sizes:
            contenders = _contenders(run, size, placements, setting)
            results += run.interleave(question_of(size), "us", contenders)
        main = placements[setting.main]
        return [*results, *run.interleave(OVERFLOW, "messages", _overflows(run, main))]

    def relations(results: Sequence[Result]) -> list[Relation]:
        medians = {(r.question, r.contender): r.summary.median for r in results}
        return measured_relations(CLAIMS, _MeasuredTimes(setting, sizes, medians))

    cpus = "; ".join(
        f"{name}: sender {p.sender}, receiver {p.receiver}, UC {p.uc}"
        for name, p in placements.items()
    )
    return Question("noc", measure, (), cpus, relations, draw)


def _contenders(
    run: Run, size: int, placements: Mapping[str, Placement], setting: Setting
) -> dict[str, Measure]:
    def of(case: Case) -> Measure:
        place = placements[setting.main if case.route == setting.between else case.route]
        memory = "ddr" if case.source == "IO DDR" else "smem"
        return lambda: _transfer(run, place, size, case.method.lower(), memory)

    main = placements[setting.main]
    return {
        **{case.name: of(case) for case in setting.cases},
        MESSAGE: lambda: _transfer(run, main, size, "message", "smem"),
        TOPIC_DSM: lambda: _topic_dsm(run, main, size),
    }


def _transfer(run: Run, place: Placement, size: int, method: str, memory: str) -> list[float]:
    found = run_program(
        "noc_transfer",
        method=method,
        memory=memory,
        bytes=size,
        cpu_1=place.sender,
        cpu_2=place.receiver,
        cpu_uc=place.uc,
        warm_up=WARM_UP,
        iterations=run.iterations(RUNS),
    )
    return [sample_ns / 1e3 for sample_ns in found["samples_ns"]]


def _topic_dsm(run: Run, place: Placement, size: int) -> list[float]:
    iterations = run.iterations(RUNS)
    with Session(BETWEEN, (place.sender, place.receiver)) as session:
        ping = session.native(
            *("round_trip", 0), role="ping", bytes=size, warm_up=WARM_UP, iterations=iterations
        )
        pong = session.native("round_trip", 1, role="pong")
        samples_ns = ping.finish()["samples_ns"]
        pong.finish()
    return [sample_ns / 2e3 for sample_ns in samples_ns]


def _overflows(run: Run, place: Placement) -> dict[str, Measure]:
    def lost(flow_control: int) -> list[float]:
        found = run_program(
            "noc_overflow",
            flow_control=flow_control,
            messages=run.iterations(OVERFLOW_MESSAGES),
            cpu_1=place.sender,
            cpu_2=place.receiver,
        )
        return [float(found["lost"])]

    return {name: partial(lost, number) for name, number in _CONTROLS.items()}
