# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Check the models with spin: each must hold, and must fail with each of its seeded bugs.

Run as `python docs/model/check.py [MODEL..]`. The head of a model lists its configurations
(` * RUN DEPTH=2`; none: one configuration without definitions) and its seeded bugs
(` * BUG 1: what`, in the first configuration, or ` * BUG 1 DEPTH=2: what`). A search that takes
half a minute is marked: ` * RUN DEPTH=3 (long)`. One that meets the bug much sooner if the last
process runs first: ` * BUG 1 (reversed): what`.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

DIRECTORY = Path(__file__).resolve().parent
PROGRAMS = ("spin", "gcc", "tcc")

MEMORY_LIMIT_MIB = 3000
DEPTH_LIMIT = 100_000  # steps of one execution; exceeding it is an error
# log2 of the hash table size. A larger table slows the search down.
TABLE, SMALL_TABLE = 24, 18

# Partial order reduction is off: it is unsound for processes that die (`unless`).
VERIFIER_OPTIONS = ("-w", "-DSAFETY", "-DNOREDUCE", f"-DMEMLIM={MEMORY_LIMIT_MIB}")


class IncompleteSearchError(RuntimeError):
    """The verifier ended before it had visited every state."""


@dataclass(frozen=True)
class Case:
    """One exhaustive search: a model in one configuration, with at most one seeded bug."""

    model: str
    defines: tuple[str, ...]
    bug: int = 0
    what: str = "as built"
    marks: str = ""

    @property
    def is_long(self) -> bool:
        return "(long)" in self.marks

    @property
    def is_reversed(self) -> bool:
        return "(reversed)" in self.marks

    @property
    def name(self) -> str:
        return "-".join([self.model, *self.defines, f"bug{self.bug}" if self.bug else "built"])


@dataclass(frozen=True)
class Outcome:
    """Result of a search."""

    violation: str  # empty if all properties hold
    states: int
    seconds: float


def cases() -> list[Case]:
    """List the checks: every model in all its configurations, then with each bug."""
    return [case for path in sorted(DIRECTORY.glob("*.pml")) for case in _cases_of(path)]


def _cases_of(path: Path) -> list[Case]:
    text = path.read_text()
    if "init {" not in text:  # included by other models only
        return []
    runs = re.findall(r"^ \* RUN ([^(\n]+)(.*)$", text, re.M) or [("", "")]
    built = [Case(path.stem, tuple(run.split()), marks=marks) for run, marks in runs]
    seeded = [
        Case(path.stem, tuple(run.split()) or built[0].defines, int(bug), what, marks)
        for bug, run, marks, what in re.findall(r"^ \* BUG (\d+)([^(:]*)(.*?): (.+)$", text, re.M)
    ]
    return built + seeded


def check(case: Case) -> Outcome:
    """Search all states of a model."""
    started = time.monotonic()
    defines = [f"-D{define}" for define in (f"BUG={case.bug}", *case.defines)]
    with tempfile.TemporaryDirectory() as directory:
        _run(["spin", *defines, "-a", str(DIRECTORY / f"{case.model}.pml")], directory)
        # A seeded bug is found early: an optimizing compiler and clearing a large table would take
        # longer than the search.
        is_short = case.bug and not case.is_long
        compiler, table = (["tcc"], SMALL_TABLE) if is_short else (["gcc", "-O1"], TABLE)
        # Short searches have memory enough for states that are not packed, which is faster.
        kind = [] if case.is_long else ["-DNOCOMP"]
        kind += ["-DREVERSE"] if case.is_reversed else []
        _run([*compiler, *kind, *VERIFIER_OPTIONS, "-o", "pan", "pan.c"], directory)
        report = _run(["./pan", f"-m{DEPTH_LIMIT}", f"-w{table}"], directory)
    return _read(report, time.monotonic() - started)


def _run(command: list[str], directory: str) -> str:
    done = subprocess.run(command, cwd=directory, text=True, capture_output=True, check=False)
    if done.returncode != 0:
        raise IncompleteSearchError(f"{command[0]}: {done.stdout}{done.stderr}")
    return done.stdout


def _read(report: str, seconds: float) -> Outcome:
    errors = re.search(r"errors: (\d+)", report)
    states = re.search(r"([\d.e+]+) states, stored", report)
    violation = re.search(r"pan:1: (assertion violated|invalid end state|.+)", report)
    complete = "Search not completed" not in report and "max search depth too small" not in report
    if errors is None or states is None or (errors[1] == "0" and not complete):
        raise IncompleteSearchError(report)
    found = violation[1] if violation else ""
    if bool(found) != (errors[1] != "0"):
        raise IncompleteSearchError(report)
    return Outcome(found, int(float(states[1])), seconds)


def main(arguments: list[str]) -> int:
    failures = 0
    for case in cases():
        if arguments and case.model not in arguments:
            continue
        outcome = check(case)
        as_expected = bool(outcome.violation) == bool(case.bug)
        failures += not as_expected
        print(
            f"{'ok  ' if as_expected else 'FAIL'} {case.name}: {case.what}: "
            f"{outcome.violation or 'holds'} "
            f"({outcome.states:,} states, {outcome.seconds:.1f} s)",
            flush=True,
        )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
