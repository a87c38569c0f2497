# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Measured latencies of a chain in an advised mapping, in the mapfile's own, and in random ones."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import yaml

from rmw_manycore_py.advice.advising import Request, advise
from rmw_manycore_py.bench.predict.figures import Figures
from rmw_manycore_py.bench.predict.mappings import movable, random_mapping
from rmw_manycore_py.bench.predict.runs import Plan, measured, profile_of
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.topology import usable_cpus
from rmw_manycore_py.prediction import TARGETS
from rmw_manycore_py.profile.model import Profile


@dataclass(frozen=True)
class Mapping:
    """A mapping and its measured runs."""

    name: str
    runs: tuple[Figures, ...]

    def p99_us(self, chain: str) -> float:
        """Return the median of the runs' p99; infinite if the chain is incomplete in a run."""
        return median(_all(self.runs, chain, "p99_us"))

    def worst_us(self, chain: str) -> float:
        """Return the maximum over all runs; infinite if the chain is incomplete in one."""
        return max(_all(self.runs, chain, "max_us"))


def _all(runs: Sequence[Figures], chain: str, name: str) -> list[float]:
    return [getattr(run.chains[chain], name) if chain in run.chains else math.inf for run in runs]


@dataclass(frozen=True)
class Contest:
    """Latency of the advised mapping, the mapfile's own and random ones.

    :ivar chain: that it was asked for.
    :ivar now: the mapfile as it is.
    :ivar loaded_now: the mapfile as it is, beside a busy loop per CPU; `loaded_advised` likewise.
    """

    chain: str
    now: Mapping
    advised: Mapping
    random: tuple[Mapping, ...]
    loaded_now: Mapping
    loaded_advised: Mapping

    @property
    def of_median(self) -> float:
        """p99 of the advised mapping / median of the random ones."""
        return self._p99_us / median(one.p99_us(self.chain) for one in self.random)

    @property
    def of_best(self) -> float:
        """p99 of the advised mapping / p99 of the best random one."""
        return self._p99_us / min(one.p99_us(self.chain) for one in self.random)

    @property
    def of_worst_case(self) -> float:
        """Maximum of the advised mapping / that of the mapfile as it is, beside busy loops."""
        return self.loaded_advised.worst_us(self.chain) / self.loaded_now.worst_us(self.chain)

    @property
    def _p99_us(self) -> float:
        return self.advised.p99_us(self.chain)


def contest(plan: Plan, topics: tuple[str, ...], note: Callable[[str], None]) -> Contest:
    """Ask for advice, and measure missing mappings.

    :param topics: of the chain that matters; empty: the longest one of the mapfile's runs.
    :raises ManycoreError: if a run fails, or if no run has a message through that chain.
    """
    plan.directory.mkdir(parents=True, exist_ok=True)
    profile = profile_of(plan, note)
    loops = len(usable_cpus())
    now = _measured(plan, plan.mapfile, note)
    chain = _chain(now, topics)
    note(f"{plan.name}: advice for {chain}")
    advised = _advised(plan, profile, _topics(chain))
    return Contest(
        chain,
        now,
        _measured(plan, advised, note),
        tuple(
            _measured(plan, random_mapping(plan.mapfile, number, plan.seed, plan.directory), note)
            for number in range(plan.mappings)
        ),
        _measured(plan, plan.mapfile, note, loops),
        _measured(plan, advised, note, loops),
    )


def _measured(plan: Plan, path: Path, note: Callable[[str], None], loops: int = 0) -> Mapping:
    runs = []
    for turn in range(plan.repetitions):
        beside = " beside busy loops" if loops else ""
        note(f"{plan.name}: {path.stem}{beside}, run {turn + 1} of {plan.repetitions}")
        runs.append(measured(plan, path, turn, loops))
    return Mapping(path.stem, tuple(runs))


def _chain(now: Mapping, topics: tuple[str, ...]) -> str:
    """Return the name of the chain through these topics, or of the longest one."""
    known = sorted(set[str].intersection(*(set(run.chains) for run in now.runs)))
    found = [name for name in known if not topics or _topics(name) == topics]
    if not found:
        wanted = " ".join(topics) or "any chain"
        text = f"no run of {now.name} has enough messages through {wanted}"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    return max(found, key=lambda name: len(_topics(name)))


def _topics(chain: str) -> tuple[str, ...]:
    """Return the topics of a chain from its name (trace.latency.ChainLatency.name)."""
    return tuple(step.split(" (")[0] for step in chain.split(" > "))


def _advised(plan: Plan, profile: Profile, topics: tuple[str, ...]) -> Path:
    """Write the mapfile that is advised for a chain, unless it is there already."""
    digest = hashlib.sha256(" ".join(topics).encode()).hexdigest()[:8]
    path = plan.directory / f"advised-{digest}.yaml"
    if not path.exists():
        text = yaml.safe_dump(movable(plan.mapfile), sort_keys=False)
        advice = advise(path, text, profile, Request(chain=topics, target=TARGETS["host"]))
        path.write_text(advice.best.candidate.text, encoding="utf-8")
    return path
