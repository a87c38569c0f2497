# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Figures of a run, measured or predicted, as kept in a file."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from pydantic import BaseModel

from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.mapping.recorded import Recorded
from rmw_manycore_py.prediction import Prediction, Sites, predict, sites_of
from rmw_manycore_py.prediction.target import HOST
from rmw_manycore_py.process.scheduling import Scheduling
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.trace.chains import Messages
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


def measured_figures(trace: Trace) -> Figures:
    """Return the figures of a trace, from when all nodes have started."""
    recorded = Recorded.of(trace)
    messages = Messages(trace)
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


def predicted_figures(mapping: Path, profile: Profile, duration_s: float, seed: int) -> Figures:
    """Return the figures that are predicted for a mapfile."""
    sites = sites_of(resolve(load_mapfile(mapping), to_start=False)).scheduled(SCHEDULING)
    one = predict(sites, profile, HOST, seed=seed, duration_s=duration_s)
    chains = {
        chain.name: Times.model_validate(chain.row())
        for chain in one.chains
        if len(chain.samples_us) >= MIN_SAMPLES
    }
    return Figures(chains=chains, cpus=_cpus(one, sites))


def _cpus(one: Prediction, sites: Sites) -> dict[int, float]:
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
