# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nominal periods of timers, from the times at which they were due.

rcl gives rmw_wait the time until the next timer is due. Due times are multiples of the period
apart, however late the callbacks begin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_MIN_DUES = 4
_MIN_COMMON = 2
_WHOLE_NS = 1_000_000
_MEASURED = 1e-3  # of a period: how far the median of measured intervals is off
_TOGETHER_NS = 50_000  # an executor calls timers in one turn that are due so near each other
_READ_NS = 1_000  # how far the median between due times is off


def nominal_ns(due_ns: Sequence[int], measured_ns: float) -> int:
    """Return a timer's period; of a measured one, where too few due times are known.

    A period that is whole milliseconds but for the error of its source is taken as these.
    """
    if len(due_ns) < _MIN_DUES:
        return _whole(measured_ns, _MEASURED * measured_ns)
    between = np.diff(np.sort(np.array(due_ns)))
    once = min(float(np.median(between)), measured_ns) or 1.0
    periods = np.rint(between / once)
    known = periods > 0
    return _whole(float(np.median(between[known] / periods[known])), _READ_NS)


def is_one_timer(period_ns: int, due_ns: Sequence[int], other_ns: Sequence[int]) -> bool:
    """Return whether other due times are those of a timer with this period."""
    if not period_ns or min(len(due_ns), len(other_ns)) < _MIN_COMMON:
        return False
    phases = [
        (np.array(times) - due_ns[0] + period_ns / 2) % period_ns - period_ns / 2
        for times in (due_ns, other_ns)
    ]
    return float(np.quantile(abs(phases[1] - np.median(phases[0])), 0.75)) <= _TOGETHER_NS


def _whole(period_ns: float, error_ns: float) -> int:
    whole_ns = round(period_ns / _WHOLE_NS) * _WHOLE_NS
    return whole_ns if whole_ns and abs(period_ns - whole_ns) <= error_ns else round(period_ns)
