# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Figures of a run, measured or predicted, as kept in a file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import median

from pydantic import BaseModel

from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.mapfile.mapping.recorded import Recorded
from rmw_manycore_py.prediction import Prediction, Sites, predict, sites_of
from rmw_manycore_py.prediction.target import HOST
from rmw_manycore_py.process.scheduling import Scheduling
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.trace.chains import Chain, Messages, Passage
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.latency import TOTAL, latencies

# Of all that is measured: other processes of the machine hardly delay it.
SCHEDULING = Scheduling("rr", 10)
MIN_SAMPLES = 20  # of a chain in a run: with fewer, its p99 says nothing


class Times(BaseModel):
    """Latency of a chain in a run."""

    count: int
    p50_us: float
    p99_us: float
    max_us: float


class Figures(BaseModel):
    """Chains by name, and the load of each host CPU as a share."""

    chains: dict[str, Times]
    cpus: dict[int, float]
    others: float = 0.0  # share of the CPUs that other processes took


class _Since(Messages):
    """Messages of a trace that were published at a time or later."""

    def __init__(self, trace: Trace, begin_ns: int) -> None:
        super().__init__(trace)
        self._begin_ns = begin_ns

    def passages(self, chain: Chain) -> list[Passage]:
        """Return the passages of these messages."""
        return [one for one in super().passages(chain) if one.published_ns[0] >= self._begin_ns]


def measured_figures(trace: Trace) -> Figures:
    """Return the figures of a trace, from when all nodes have started."""
    recorded = Recorded.of(trace)
    messages = _Since(trace, recorded.begin_ns)
    chains = {}
    for one in latencies(messages, messages.chains):
        (total,) = (part for part in one.parts if part.name == TOTAL)
        if len(total.samples_us) >= MIN_SAMPLES:
            chains[one.name] = Times(
                count=len(total.samples_us),
                p50_us=total.quantile(0.5),
                p99_us=total.quantile(0.99),
                max_us=total.quantile(1.0),
            )
    cpus: dict[int, float] = defaultdict(float)
    for load in recorded.loads():
        if load.process.host_cpu is not None:
            cpus[load.process.host_cpu] += load.cpu_share
    return Figures(chains=chains, cpus=dict(cpus))


def predicted_figures(
    mapping: Path, profile: Profile, duration_s: float, seeds: Iterable[int]
) -> Figures:
    """Return the typical figures of runs that are predicted for a mapfile.

    The phases between timers differ from run to run and stay within one, so each seed is a run.
    """
    sites = sites_of(resolve(load_mapfile(mapping), to_start=False)).scheduled(SCHEDULING)
    return typical([_predicted(sites, profile, duration_s, seed) for seed in seeds])


def typical(runs: Sequence[Figures]) -> Figures:
    """Return the medians of the chains that most runs have, and of the loads."""
    found = defaultdict(list)
    for run in runs:
        for name, times in run.chains.items():
            found[name].append(times)
    chains = {
        name: Times(
            count=round(median(one.count for one in times)),
            p50_us=median(one.p50_us for one in times),
            p99_us=median(one.p99_us for one in times),
            max_us=median(one.max_us for one in times),
        )
        for name, times in found.items()
        if len(times) > len(runs) / 2
    }
    numbers = sorted(set[int]().union(*(run.cpus for run in runs)))
    return Figures(
        chains=chains,
        cpus={number: median(run.cpus.get(number, 0.0) for run in runs) for number in numbers},
        others=max((run.others for run in runs), default=0.0),
    )


def _predicted(sites: Sites, profile: Profile, duration_s: float, seed: int) -> Figures:
    one = predict(sites, profile, HOST, seed=seed, duration_s=duration_s)
    chains = {
        chain.name: Times.model_validate(chain.row())
        for chain in one.chains
        if len(chain.samples_us) >= MIN_SAMPLES
    }
    return Figures(chains=chains, cpus=_pinned_loads(one, sites))


def _pinned_loads(one: Prediction, sites: Sites) -> dict[int, float]:
    """Return the loads of CPUs by what is pinned: a trace does not tell where the rest ran."""
    cpus: dict[int, float] = defaultdict(float)
    for core in one.cores:
        site = sites.of(core.nodes[0])
        if site is not None and len(site.host_cpus) == 1:
            cpus[site.host_cpus[0]] += core.cpu_share
    for thread in one.receive_threads:
        cpu = sites.receive_cpus.get(thread.cluster)
        if cpu is not None:
            cpus[cpu] += thread.cpu_share
    return dict(cpus)
