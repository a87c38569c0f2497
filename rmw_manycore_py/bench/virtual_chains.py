# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chains of a run in virtual time beside those of the simulator: one model, executed twice."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.prediction import predict, sites_of
from rmw_manycore_py.prediction.target_file import target_named
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import Events, Kind, Process, Trace
from rmw_manycore_py.trace.latency import TOTAL, Part, latencies

_MIN_MESSAGES = 10


@dataclass(frozen=True)
class ComparedChain:
    """A chain's latency from the moment at which its first message was written."""

    name: str
    virtual: Part
    simulated: Part

    @property
    def deviation(self) -> float:
        """Relative difference of the medians."""
        return self.deviation_at(0.5)

    def deviation_at(self, share: float) -> float:
        """Relative difference of a quantile."""
        return abs(self.virtual.quantile(share) / self.simulated.quantile(share) - 1.0)

    def row(self) -> dict[str, str | float]:
        """Return the JSON row, of medians."""
        times = {"virtual_us": self.virtual, "simulated_us": self.simulated}
        return {"name": self.name, **{key: one.quantile(0.5) for key, one in times.items()}}


def compared_chains(
    trace: Trace, mapfile: Path, profile: Profile, platform: str, seed: int, duration_s: float
) -> Iterator[ComparedChain]:
    """Yield the chains that at least ten messages went through in both executions.

    The simulated timers start together, as those of nodes in virtual time do.
    """
    predicted = predict(
        sites_of(resolve(load_mapfile(mapfile))),
        profile,
        target_named(platform),
        seed=seed,
        duration_s=duration_s,
        chains=(),
        is_traced=True,
        timers_together=True,
    )
    assert predicted.trace is not None
    virtual, simulated = _totals(trace), _totals(predicted.trace)
    for name in sorted(virtual.keys() & simulated.keys()):
        yield ComparedChain(name, virtual[name], simulated[name])


def _totals(trace: Trace) -> dict[str, Part]:
    messages = Messages(_from_writes(trace))
    return {
        chain.name: part
        for chain in latencies(messages, messages.chains)
        for part in chain.parts
        if part.name == TOTAL and len(part.samples_us) >= _MIN_MESSAGES
    }


def _from_writes(trace: Trace) -> Trace:
    """Return a trace whose publications begin when their messages are written.

    A thread in virtual time states a publication before it begins, and goes on when it has ended.
    """

    def moved(process: Process) -> Process:
        threads = (replace(one, events=_moved(one.events)) for one in process.threads)
        return replace(process, threads=tuple(threads))

    return replace(trace, processes=tuple(map(moved, trace.processes)))


def _moved(events: Events) -> Events:
    begins = np.flatnonzero(events["kind"] == Kind.PUBLISH_BEGIN)
    writes = np.flatnonzero(events["kind"] == Kind.WRITE)
    following = np.searchsorted(writes, begins)
    begins, following = begins[following < len(writes)], following[following < len(writes)]
    moved: Events = events.copy()
    moved["time_ns"][begins] = events["time_ns"][writes[following]]
    return moved
