# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chains of a CARET report: predicted from callbacks and architecture, then compared.

The prediction gets a profile, which has no latency of a chain. Only when it is made, the latencies
that the report has measured are read from stats_path.yaml.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import yaml

from rmw_manycore_py.errors import FileError, Problem
from rmw_manycore_py.prediction import Sites, predict
from rmw_manycore_py.prediction.target import HOST, Target
from rmw_manycore_py.profile.caret import import_report
from rmw_manycore_py.profile.model import Profile

_DURATION_S = 60.0
ANSWERS = "stats_path.yaml"
# Callback times of a report hold waiting for a CPU already, so that no thread waits for one again.
UNSHARED: Target = replace(HOST, name="a CPU per thread", cpus="own")


@dataclass(frozen=True)
class ReportedChain:
    """A chain of a report: its best-case p50, measured and predicted."""

    chain: str
    measured_ms: float
    predicted_ms: float
    error: float


def reported_chains(directory: Path, seed: int) -> list[ReportedChain]:
    """Predict the chains of a report, and compare them with what it has measured.

    :raises FileError: if the report lacks a file, or names another chain.
    """
    predicted_ms = predicted_chains(import_report(directory), seed)
    measured_ms = _answers(directory)
    return [
        ReportedChain(name, measured, predicted_ms[name], predicted_ms[name] / measured - 1)
        for name, measured in measured_ms.items()
        if name in predicted_ms
    ]


def predicted_chains(profile: Profile, seed: int) -> dict[str, float]:
    """Return the predicted best-case p50 of each chain in ms."""
    found = predict(Sites({}), profile, UNSHARED, seed=seed, duration_s=_DURATION_S)
    medians = {one.name: one.quantile_us(0.5) for one in found.chains}
    return {name: value / 1e3 for name, value in medians.items() if value is not None}


def _answers(directory: Path) -> dict[str, float]:
    paths = sorted(directory.rglob(ANSWERS))
    if not paths:
        raise FileError(Problem(directory, 0, "", f"latencies of chains ({ANSWERS})", "none"))
    rows = yaml.safe_load(paths[0].read_text(encoding="utf-8"))
    return {row["target_path_name"]: float(row["best_p50"]) for row in rows}
