# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Distributions of measured samples."""

from __future__ import annotations

from array import array

import numpy as np

from rmw_manycore_py.profile.model import Distribution

# Close together where simulated maxima and p99 come from.
SHARES = (*(round(0.05 * i, 2) for i in range(20)), 0.975, 0.99, 0.995, 0.999, 1.0)


def distribution_of(samples: array[int]) -> Distribution | None:
    """Return the distribution of some samples, or None if there are none."""
    if not samples:
        return None
    values = np.frombuffer(samples, np.int64)
    quantiles = np.round(np.quantile(values, SHARES), 1)
    return Distribution(
        count=len(samples), mean=float(values.mean()), quantiles=tuple(quantiles.tolist())
    )


def intervals_of(times_ns: array[int]) -> Distribution | None:
    """Return the distribution of the intervals between some times, in any order."""
    ordered = np.sort(np.frombuffer(times_ns, np.int64))
    return distribution_of(array("q", np.diff(ordered).tobytes()))
