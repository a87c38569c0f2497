# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profile, mappings and measured runs of an application, kept in a directory to go on later."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.load import busy
from rmw_manycore_py.bench.predict.figures import (
    SCHEDULING,
    Figures,
    measured_figures,
    predicted_figures,
)
from rmw_manycore_py.bench.predict.mappings import random_mapping
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.platform.topology import usable_cpus
from rmw_manycore_py.process.scheduling import Scheduling, scheduled_as
from rmw_manycore_py.profile.files import load as load_profile
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.trace.atomic_file import atomic_write
from rmw_manycore_py.trace.files import load as load_trace

_PREDICTED_RUNS = 9  # whose median is compared
_START_S = 120.0  # within which the nodes of an application have started


@dataclass(frozen=True)
class Plan:
    """What to measure of an application.

    :ivar directory: of its files; runs that are there are not measured again.
    """

    mapfile: Path
    directory: Path
    mappings: int
    repetitions: int
    duration_s: float
    seed: int

    @property
    def name(self) -> str:
        """Name of the application."""
        return self.mapfile.stem


@dataclass(frozen=True)
class Compared:
    """A mapping: its measured runs, and its prediction."""

    number: int
    runs: Sequence[Figures]
    predicted: Figures


def compared(plan: Plan, note: Callable[[str], None]) -> list[Compared]:
    """Measure missing runs, predict all mappings, and return both.

    Each mapping runs once before any runs again: what the machine does meanwhile meets all alike.

    :raises ManycoreError: if a run fails.
    """
    plan.directory.mkdir(parents=True, exist_ok=True)
    profile = profile_of(plan, note)
    mappings = [
        random_mapping(plan.mapfile, number, plan.seed, plan.directory)
        for number in range(plan.mappings)
    ]
    runs: list[list[Figures]] = [[] for _ in mappings]
    for turn in range(plan.repetitions):
        for number, mapping in enumerate(mappings):
            what = f"run {turn + 1} of {plan.repetitions}, mapping {number + 1} of {plan.mappings}"
            note(f"{plan.name}: {what}")
            runs[number].append(measured(plan, mapping, turn))
    seeds = range(plan.seed, plan.seed + _PREDICTED_RUNS)
    return [
        Compared(number, own, predicted_figures(mapping, profile, plan.duration_s, seeds))
        for number, (mapping, own) in enumerate(zip(mappings, runs, strict=True))
    ]


def profile_of(plan: Plan, note: Callable[[str], None]) -> Profile:
    """Return the profile of a plan's mapfile; record it unless it is there already.

    :raises ManycoreError: if the run fails.
    """
    path = plan.directory / "profile.json"
    if not path.exists():
        note(f"{plan.name}: profile of {plan.mapfile}")
        options = ("--duration", f"{plan.duration_s * 3:g}", "-o", str(path))
        _run(plan, "profile", "record", str(plan.mapfile), *options, duration_s=plan.duration_s * 3)
    return load_profile(path)


def measured(plan: Plan, mapping: Path, turn: int, loops: int = 0) -> Figures:
    """Return the figures of a run of a mapping; run it unless that was done already.

    :param loops: busy loops beside the run, which is not in real time then.
    :raises ManycoreError: if the run fails.
    """
    beside = f"-beside-{loops}" if loops else ""
    path = plan.directory / f"{mapping.stem}{beside}-run-{turn + 1}.json"
    if not path.exists():
        trace = plan.directory / "trace.csv"
        options = ("--duration", f"{plan.duration_s:g}", "--trace", str(trace))
        with busy(loops, usable_cpus(), _START_S + plan.duration_s):
            others = _run(
                plan,
                "run",
                str(mapping),
                *options,
                duration_s=plan.duration_s,
                scheduling=None if loops else SCHEDULING,
            )
        figures = measured_figures(load_trace(trace)).model_copy(update={"others": others})
        trace.unlink()
        with atomic_write(path) as file:
            file.write(figures.model_dump_json().encode())
    return Figures.model_validate_json(path.read_bytes())


def _run(
    plan: Plan, *words: str, duration_s: float, scheduling: Scheduling | None = SCHEDULING
) -> float:
    """Run a command; return the share of the CPUs that other processes took."""
    command = own_program("rmw_manycore_py.cli", *words)
    begin_s, busy_s, own_s = time.monotonic(), _busy_s(), _children_s()
    try:
        with scheduled_as(scheduling):
            process = subprocess.Popen(
                command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
            )
        text, _ = process.communicate(timeout=_START_S + duration_s)
    except OSError as error:
        raise ManycoreError(f"{plan.name}: {error.strerror}") from error
    except subprocess.TimeoutExpired as error:
        process.send_signal(signal.SIGINT)
        process.communicate()
        text = f"{plan.name}: the run did not end: manycore {' '.join(words)}"
        raise ManycoreError(text) from error
    if process.returncode:
        last = "".join(text.strip().splitlines()[-1:])
        raise ManycoreError(f"{plan.name}: manycore {' '.join(words)}: {last}")
    span_s = (time.monotonic() - begin_s) * (os.cpu_count() or 1)
    return max(_busy_s() - busy_s - (_children_s() - own_s), 0.0) / span_s


def _busy_s() -> float:
    """Return the time for which CPUs were busy since the boot."""
    user, nice, system, _idle, _waiting, *interrupts = map(
        int, Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:8]
    )
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
