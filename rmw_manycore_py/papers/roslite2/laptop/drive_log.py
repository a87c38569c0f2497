# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Log of a drive, and its summary."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from rmw_manycore_py.ndt.nodes.support.log_throttle import LogThrottle

STANDING_M_S = 0.02  # lower speeds count as standing
REPEAT_S = 10.0
DEADLINE_S = 0.1  # from scan to the first command based on it; more is late


@dataclass
class Scan:
    """How a scan became a command; times in seconds on the wall clock."""

    stamp_s: float
    pose_s: float | None = None  # arrival of its pose
    kinematics_s: float | None = None  # stamp of the first prediction after that
    control_s: float | None = None  # stamp of the first gated command after that
    command_s: float | None = None  # arrival of the first cmd_vel after that

    @property
    def latency_s(self) -> float | None:
        """From the stamp to the first cmd_vel based on the scan."""
        return None if self.command_s is None else self.command_s - self.stamp_s


@dataclass(frozen=True)
class Moment:
    """True state of the vehicle at a time."""

    time_s: float  # wall clock
    x_m: float
    y_m: float
    speed_m_s: float
    along_m: float
    lateral_m: float


@dataclass(frozen=True)
class Command:
    """A received cmd_vel."""

    time_s: float
    speed_m_s: float
    yaw_rate_rad_s: float


@dataclass(frozen=True)
class Incident:
    """Warning or restart of a program, or a fault."""

    time_s: float
    text: str


@dataclass(frozen=True)
class Injected:
    """A fault injected into a process or a sensor."""

    time_s: float
    target: str
    text: str


@dataclass(frozen=True)
class Summary:
    """Summary of a drive; latencies and periods in ms, None if not measured."""

    driven_m: float
    course_m: float
    is_finished: bool
    duration_s: float
    speed_m_s_mean: float
    lateral_m_rms: float
    lateral_m_max: float
    latency_ms_median: float | None
    latency_ms_p99: float | None
    command_period_ms_median: float | None
    command_period_ms_p99: float | None
    scans: int
    scans_lost: int
    scans_late: int
    stands: int  # number of stops before the end
    bridge_cpu_percent: float | None
    platform_cpu_percent: float | None
    laptop_cpu_s: float
    packets_in: int | None  # received by the stack's network namespace


@dataclass
class DriveLog:
    """Everything recorded, from the first driving command on."""

    course_m: float
    scans: dict[int, Scan] = field(default_factory=dict)  # by stamp [ns]
    moments: list[Moment] = field(default_factory=list)
    commands: list[Command] = field(default_factory=list)
    incidents: list[Incident] = field(default_factory=list)
    injected: list[Injected] = field(default_factory=list)
    bridge_cpu_percent: float | None = None
    platform_cpu_percent: float | None = None
    laptop_cpu_s: float = 0.0
    packets_in: int | None = None
    is_finished: bool = False
    _telling: threading.Lock = field(default_factory=threading.Lock)
    _throttle: LogThrottle = field(default_factory=lambda: LogThrottle(REPEAT_S))

    def tell(self, text: str) -> None:
        """Add an incident; repetitions that differ only in numbers are rate-limited.

        Thread-safe.
        """
        with self._telling:
            if self._throttle.is_due(text):
                self.incidents.append(Incident(time.time(), text))

    def start_s(self) -> float | None:
        """Return when the vehicle was first commanded to move."""
        return next((one.time_s for one in self.commands if one.speed_m_s > 0.0), None)

    def driven(self) -> list[Moment]:
        """Return the moments since the vehicle was first commanded to move."""
        start_s = self.start_s()
        return [] if start_s is None else [m for m in self.moments if m.time_s >= start_s]

    def judged(self) -> list[Scan]:
        """Return the scans since then that had time to become a command."""
        start_s = self.start_s()
        if start_s is None or not self.commands:
            return []
        end_s = self.commands[-1].time_s - 2.0 * DEADLINE_S
        return [one for one in self.scans.values() if start_s <= one.stamp_s <= end_s]

    def summary(self) -> Summary:
        """Return the summary."""
        driven, scans = self.driven(), self.judged()
        latencies, periods = self.latencies_ms(), self.periods_ms()
        lateral = np.array([one.lateral_m for one in driven] or [np.nan])
        duration_s = driven[-1].time_s - driven[0].time_s if driven else 0.0
        way_m = driven[-1].along_m - driven[0].along_m if driven else 0.0
        return Summary(
            driven_m=way_m,
            course_m=self.course_m,
            is_finished=self.is_finished,
            duration_s=duration_s,
            speed_m_s_mean=way_m / duration_s if duration_s else 0.0,
            lateral_m_rms=float(np.sqrt(np.mean(lateral**2))),
            lateral_m_max=float(np.abs(lateral).max()),
            latency_ms_median=_quantile(latencies, 0.5),
            latency_ms_p99=_quantile(latencies, 0.99),
            command_period_ms_median=_quantile(periods, 0.5),
            command_period_ms_p99=_quantile(periods, 0.99),
            scans=len(scans),
            scans_lost=sum(one.latency_s is None for one in scans),
            scans_late=sum((one.latency_s or 0.0) > DEADLINE_S for one in scans),
            stands=self._stands(driven),
            bridge_cpu_percent=self.bridge_cpu_percent,
            platform_cpu_percent=self.platform_cpu_percent,
            laptop_cpu_s=self.laptop_cpu_s,
            packets_in=self.packets_in,
        )

    def latencies_ms(self) -> list[float]:
        """Return the latencies of all scans that became a command."""
        return [1e3 * one.latency_s for one in self.judged() if one.latency_s is not None]

    def periods_ms(self) -> list[float]:
        """Return the times between commands."""
        periods: list[float] = (1e3 * np.diff([c.time_s for c in self._while_driving()])).tolist()
        return periods

    def _while_driving(self) -> list[Command]:
        start_s = self.start_s()
        return [] if start_s is None else [c for c in self.commands if c.time_s >= start_s]

    def _stands(self, driven: list[Moment]) -> int:
        """Count the stops of a moving vehicle before the end of the course."""
        moves = [one.speed_m_s > STANDING_M_S for one in driven]
        stops = sum(before and not now for before, now in pairwise(moves))
        stands_at_end = self.is_finished and stops > 0 and not moves[-1]
        return stops - stands_at_end


def _quantile(values: list[float], share: float) -> float | None:
    return float(np.quantile(values, share)) if len(values) else None
