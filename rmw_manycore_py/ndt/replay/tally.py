# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Outcome of each played scan, and summary figures."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix

DIVERGED_M, DIVERGED_DEG = 1.0, 10.0


@dataclass
class Played:
    """A scan; errors are relative to the reference pose, latency runs from sending to the pose.

    :param stamp_s: stamp in the recording.
    :param guess: None if the stack on the platform makes it.
    :param covariance: (6, 6) in the map frame.
    :param reason: message of the matcher's diagnostics for the scan.
    :param report: values of its diagnostics.
    """

    index: int
    stamp_s: float
    reference: Matrix
    guess: Matrix | None
    sent_s: float
    latency_ms: float | None = None
    result: Matrix | None = None
    covariance: Matrix | None = None
    reason: str = ""
    report: dict[str, str] = field(default_factory=dict)

    @property
    def guess_error(self) -> tuple[float, float] | None:
        """Return the error of the guess in metres and degrees."""
        return None if self.guess is None else _error(self.reference, self.guess)

    @property
    def error(self) -> tuple[float, float] | None:
        """Return the error of the result in metres and degrees."""
        return None if self.result is None else _error(self.reference, self.result)


@dataclass(frozen=True)
class Summary:
    """Summary of a replay; errors and latencies are those of answered scans."""

    scans: int
    answered: int
    lost: int
    late: int
    diverged: int
    guess_error_m_max: float
    guess_error_deg_max: float
    error_m_median: float
    error_m_p99: float
    error_m_max: float
    error_deg_median: float
    error_deg_max: float
    within_share: float  # share of all scans within 0.2 m and 1 degree
    latency_ms_median: float
    latency_ms_p99: float
    latency_ms_max: float
    rate_hz: float  # at which scans were sent
    wanted_hz: float | None  # None: each waited for the answer to the last one
    node_cpu_percent: float | None

    @property
    def is_good(self) -> bool:
        """Return whether every scan was answered in time and near the reference."""
        return self.lost == 0 and self.late == 0 and self.diverged == 0


@dataclass
class Tally:
    """All scans played so far.

    :param wanted_hz: rate at which scans are due, if they do not wait for answers.
    """

    deadline_ms: float
    wanted_hz: float | None = None
    rows: list[Played] = field(default_factory=list)
    cpu_s: list[tuple[float, float]] = field(default_factory=list)  # (wall, CPU) of the node

    def answered(self) -> list[Played]:
        """Return the scans that have a result."""
        return [row for row in self.rows if row.result is not None]

    def late(self) -> int:
        """Return the number of answers after the deadline."""
        return sum((row.latency_ms or 0.0) > self.deadline_ms for row in self.answered())

    def lost(self) -> int:
        """Return the number of scans without an answer."""
        return sum(row.result is None for row in self.rows)

    def complaint(self) -> str:
        """Return what the matcher reported of the first lost scan; "" if nothing."""
        return next((row.reason for row in self.rows if row.result is None), "")

    def state(self, row: Played) -> str:
        """Return the outcome of a scan: answered, late or lost."""
        if row.result is None:
            return "lost"
        return "late" if (row.latency_ms or 0.0) > self.deadline_ms else "answered"

    def summary(self) -> Summary:
        """Return the summary."""
        answered = self.answered()
        errors = np.array([row.error for row in answered]).reshape(-1, 2)
        guesses = np.array([r.guess_error for r in self.rows if r.guess is not None]).reshape(-1, 2)
        latencies = np.array([row.latency_ms for row in answered], np.float64)
        diverged = (errors[:, 0] > DIVERGED_M) | (errors[:, 1] > DIVERGED_DEG)
        within = (errors[:, 0] <= 0.2) & (errors[:, 1] <= 1.0)
        return Summary(
            scans=len(self.rows),
            answered=len(answered),
            lost=self.lost(),
            late=self.late(),
            diverged=int(diverged.sum()),
            guess_error_m_max=_figure(guesses[:, 0], 100),
            guess_error_deg_max=_figure(guesses[:, 1], 100),
            error_m_median=_figure(errors[:, 0], 50),
            error_m_p99=_figure(errors[:, 0], 99),
            error_m_max=_figure(errors[:, 0], 100),
            error_deg_median=_figure(errors[:, 1], 50),
            error_deg_max=_figure(errors[:, 1], 100),
            within_share=float(within.sum()) / max(len(self.rows), 1),
            latency_ms_median=_figure(latencies, 50),
            latency_ms_p99=_figure(latencies, 99),
            latency_ms_max=_figure(latencies, 100),
            rate_hz=self._rate_hz(),
            wanted_hz=self.wanted_hz,
            node_cpu_percent=self._cpu_percent(),
        )

    def _rate_hz(self) -> float:
        span_s = self.rows[-1].sent_s - self.rows[0].sent_s if self.rows else 0.0
        return (len(self.rows) - 1) / span_s if span_s > 0.0 else float("nan")

    def _cpu_percent(self) -> float | None:
        """Return CPU time over wall time between the node's first and last report."""
        if len(self.cpu_s) < 2:
            return None
        (first_wall, first_cpu), (last_wall, last_cpu) = self.cpu_s[0], self.cpu_s[-1]
        wall_s = last_wall - first_wall
        return 100.0 * (last_cpu - first_cpu) / wall_s if wall_s > 0.0 else None


def as_json(summary: Summary) -> dict[str, Any]:
    """Return the summary as JSON data; NaN (nothing answered) becomes None."""
    return {k: None if v != v else v for k, v in asdict(summary).items()}


def _error(reference: Matrix, T: Matrix) -> tuple[float, float]:
    return poses.distance_m(reference, T), float(np.degrees(poses.angle_rad(reference, T)))


def _figure(values: Matrix, percentile: float) -> float:
    return float(np.percentile(values, percentile)) if len(values) else float("nan")
