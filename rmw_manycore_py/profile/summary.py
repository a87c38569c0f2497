# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Counts of a profile."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rmw_manycore_py.profile.model import Profile


def summary_of(profile: Profile) -> dict[str, Any]:
    """Return what `manycore profile show --json` prints; None where the source does not say."""
    ran = [one for one in profile.callbacks if one.rate_hz]
    duration_ns = profile.duration_ns
    return {
        "source": profile.source,
        "duration_s": None if duration_ns is None else duration_ns / 1e9,
        "events": profile.events,
        "processes": len(profile.processes),
        "nodes": len(profile.nodes),
        "publishers": len(profile.publishers),
        "subscriptions": len(profile.subscriptions),
        "callbacks": len(ran),
        "executions": _sum(one.executions for one in ran),
        "publications": _publications(profile),
        "cpus_busy": sum(one.load_cpus for one in ran),
        "chains": len(profile.chains),
        **profile.coverage.model_dump(),
    }


def _publications(profile: Profile) -> int | None:
    known = _sum(one.publications for one in profile.publishers)
    return None if known is None else known + profile.coverage.publications_of_unknown_publishers


def _sum(counts: Iterable[int | None]) -> int | None:
    """Return the sum of counts, or None if one is unknown."""
    total = 0
    for count in counts:
        if count is None:
            return None
        total += count
    return total
