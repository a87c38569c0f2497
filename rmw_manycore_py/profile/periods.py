# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nominal periods of timers, from the times at which they were due.

rcl gives rmw_wait the time until the next timer is due. Due times are multiples of the period
apart, however late the callbacks begin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_MIN_DUES = 4
_WHOLE_NS = 1_000_000
_MEASURED = 1e-3  # of a period: how far the median of measured intervals is off
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


def _whole(period_ns: float, error_ns: float) -> int:
    whole_ns = round(period_ns / _WHOLE_NS) * _WHOLE_NS
    return whole_ns if whole_ns and abs(period_ns - whole_ns) <= error_ns else round(period_ns)
