# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Worth of this machine's clusters: cache lines, wake-ups, copies and messages between its CPUs."""

from __future__ import annotations

import csv
import statistics
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

from rmw_manycore_py.bench.contenders import BETWEEN, FUTEX, INSIDE, MIB, Middleware
from rmw_manycore_py.bench.question import PAYLOADS, Measure, Question, Run
from rmw_manycore_py.bench.round_trip import WARM_UP, in_us, iterations
from rmw_manycore_py.bench.session import Session, run_peer, run_program
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.picture.plotting import load_figure
from rmw_manycore_py.platform.machine.clusters import HostCluster
from rmw_manycore_py.platform.machine.pairs import KINDS, kind_of, nearest_pairs
from rmw_manycore_py.platform.machine.sysfs import Cpu

LINE = "cache line, one way"
SIZES = ("64 B", "1 MiB")
_PASSES = 20_000
_WAKE_UPS = 2000
_COPIES = 200
Pair = tuple[int, int]


class CacheLines:
    """Matrix of one-way times of a cache line between all cores, in ns."""

    def __init__(self, cpus: Sequence[Cpu], clusters: Sequence[HostCluster]) -> None:
        """Take one hardware thread of each core, and all of the first one."""
        chosen = [cpu for cpu in cpus if cpu.thread == 0 or cpu.number in cpus[0].threads]
        self.numbers = sorted(cpu.number for cpu in chosen)
        by_number = {cpu.number: cpu for cpu in chosen}
        self.pairs: list[Pair] = list(combinations(self.numbers, 2))
        self._kinds = [kind_of(by_number[a], by_number[b], clusters) for a, b in self.pairs]
        self._samples: dict[Pair, list[float]] = {}

    def measure(self, run: Run) -> list[Result]:
        """Measure each pair in each round; return the samples by what the CPUs have in common."""
        wanted = [kind for kind in KINDS if run.wants(f"{LINE}: {kind}") and kind in self._kinds]
        if not wanted:
            return []
        for turn in range(run.rounds):
            run.note(f"{LINE}, round {turn + 1} of {run.rounds}: {len(self.pairs)} pairs")
            found = run_program(
                "machine_pairs",
                what="line",
                cpus=",".join(map(str, self.numbers)),
                iterations=run.iterations(_PASSES),
            )
            for pair, sample in zip(self.pairs, found["samples_ns"], strict=True):
                self._samples.setdefault(pair, []).append(sample)
        return [Result(LINE, kind, "ns", self._of_kind(kind)) for kind in wanted]

    def draw(self, _results: Sequence[Result], directory: Path) -> list[Path]:
        """Write the medians as matrix.csv and matrix.svg; return their paths."""
        if not self._samples:
            return []
        rows = [[self._median(a, b) for b in self.numbers] for a in self.numbers]
        table, picture = directory / "matrix.csv", directory / "matrix.svg"
        with table.open("w", newline="") as file:
            csv.writer(file).writerows(
                [["CPU", *self.numbers]]
                + [[cpu, *row] for cpu, row in zip(self.numbers, rows, strict=True)]
            )
        figure = load_figure()(figsize=(7, 6), layout="constrained")
        panel = figure.subplots()
        image = panel.imshow([[float("nan") if x == "" else x for x in row] for row in rows])
        step = max(len(self.numbers) // 16, 1)
        places = range(0, len(self.numbers), step)
        names = [str(self.numbers[place]) for place in places]
        panel.set(title=LINE, xlabel="CPU", ylabel="CPU")
        panel.set_xticks([*places], names)
        panel.set_yticks([*places], names)
        figure.colorbar(image, label="ns")
        figure.savefig(picture)
        return [table, picture]

    def _of_kind(self, kind: str) -> tuple[float, ...]:
        pairs = [pair for pair, own in zip(self.pairs, self._kinds, strict=True) if own == kind]
        return tuple(sample for pair in pairs for sample in self._samples[pair])

    def _median(self, one: int, other: int) -> float | str:
        samples = self._samples.get((min(one, other), max(one, other)))
        return statistics.median(samples) if samples else ""


def questions(cpus: Sequence[Cpu], clusters: Sequence[HostCluster]) -> list[Question]:
    """Return the questions on a machine's CPUs."""
    lines = CacheLines(cpus, clusters)
    pairs = nearest_pairs(cpus, clusters)
    between = "; ".join(f"{kind}: {a} and {b}" for kind, (a, b) in pairs.items())
    return [
        Question("cache line", lines.measure, placement="all cores", draw=lines.draw),
        Question("wake-up", lambda run: _wake_ups(run, pairs), placement=between),
        Question("copy", lambda run: _copies(run, pairs), placement=between),
        Question("message", lambda run: _messages(run, pairs), placement=between),
    ]


def _wake_ups(run: Run, pairs: dict[str, Pair]) -> list[Result]:
    """Measure half of a round trip of two processes that sleep on futexes."""

    def of(pair: Pair) -> Measure:
        count = run.iterations(_WAKE_UPS)
        return lambda: [
            sample / 2
            for sample in in_us(
                run_peer(FUTEX, pair, bytes=8, warm_up=WARM_UP, iterations=count)["samples_ns"]
            )
        ]

    return run.interleave("wake-up, one way", "us", {k: of(pair) for k, pair in pairs.items()})


def _copies(run: Run, pairs: dict[str, Pair]) -> list[Result]:
    """Measure copies of what the other CPU has just written."""

    def of(pair: Pair) -> Measure:
        count = run.iterations(_COPIES)
        cpus = f"{pair[0]},{pair[1]}"

        def measure() -> Sequence[float]:
            found = run_program(
                "machine_pairs", what="copy", cpus=cpus, bytes=MIB, iterations=count
            )
            return in_us(found["samples_ns"])

        return measure

    return run.interleave("copy of 1 MiB", "us", {k: of(pair) for k, pair in pairs.items()})


def _messages(run: Run, pairs: dict[str, Pair]) -> list[Result]:
    """Measure round trips of native nodes, in one cluster of the platform and in two."""

    def of(middleware: Middleware, pair: Pair, size: str) -> Measure:
        def measure() -> Sequence[float]:
            with Session(middleware, pair) as session:
                ping = session.native(
                    "round_trip",
                    0,
                    role="ping",
                    bytes=PAYLOADS[size],
                    warm_up=WARM_UP,
                    iterations=run.iterations(iterations(PAYLOADS[size])),
                )
                pong = session.native("round_trip", 1, role="pong")
                found = ping.finish()
                pong.finish()
            return in_us(found["samples_ns"])

        return measure

    results = []
    for size in SIZES:
        contenders = {
            f"{kind}, {middleware.name}": of(middleware, pair, size)
            for kind, pair in pairs.items()
            for middleware in (INSIDE, BETWEEN)
        }
        results += run.interleave(f"round trip {size}", "us", contenders)
    return results
