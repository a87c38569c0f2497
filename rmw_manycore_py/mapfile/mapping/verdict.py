# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Facts about a placement as one verdict in words, and as JSON data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

from rmw_manycore_py.mapfile import ClusterMemory
from rmw_manycore_py.mapfile.mapping.crossing import Crossing
from rmw_manycore_py.mapfile.mapping.facts import Facts
from rmw_manycore_py.mapfile.mapping.rates import TracedFacts
from rmw_manycore_py.platform.texts import counted, listed, size_text

Fit = Literal["fits", "tight", "too small"]
_MAX_NAMES = 5


def fit_of(facts: Facts) -> Fit:
    """Return whether the clusters have room for what is placed there."""
    fullest = _fullest(facts)
    if fullest.total > fullest.smem_size:
        return "too small"
    return "tight" if fullest.total > fullest.room else "fits"


def verdict(facts: Facts) -> str:
    """Return one sentence on memory, on what crosses clusters, and on the busiest core."""
    return "; ".join([*_memory(facts), *_crossing(facts), *_load(facts.traced), *_unknown(facts)])


def _fullest(facts: Facts) -> ClusterMemory:
    return max(facts.memory, key=lambda one: one.total / one.smem_size)


def _memory(facts: Facts) -> Iterator[str]:
    one = _fullest(facts)
    taken = f"{size_text(one.total)} of {size_text(one.smem_size)}"
    if one.total > one.smem_size:
        yield f"it does not fit, cluster {one.cluster} needs {taken}"
    elif one.total > one.room:
        room = f"{size_text(one.room)} beside its reserve"
        yield f"it may not fit, cluster {one.cluster} needs {size_text(one.total)} of {room}"
    else:
        yield f"it fits, cluster {one.cluster} is fullest with {taken}"
    if facts.growing:
        sizes = "whose size is" if len(facts.growing) == 1 else "whose sizes are"
        yield f"not counted: {counted(len(facts.growing), 'topic')} {sizes} not known"


def _crossing(facts: Facts) -> Iterator[str]:
    crossing, known = len(facts.crossing_topics), len(facts.topics)
    if not known:
        yield "no topic is known"
    elif not crossing:
        yield f"none of {counted(known, 'topic')} crosses clusters"
    else:
        yield f"{_which(crossing, known)} clusters{_rate(facts)}"


def _which(crossing: int, known: int) -> str:
    if crossing < known:
        return f"{crossing} of {known} topics {'crosses' if crossing == 1 else 'cross'}"
    whole = {1: "the only topic crosses", 2: "both topics cross"}
    return whole.get(known, f"all {known} topics cross")


def _rate(facts: Facts) -> str:
    if facts.traced is None:
        return ""
    return f", {rates_text(*totals(facts))}"


def rates_text(messages_per_s: float, bytes_per_s: float) -> str:
    """Format the rates of some traffic."""
    return f"{messages_per_s:.1f} messages/s and {size_text(round(bytes_per_s))}/s"


def totals(facts: Facts) -> tuple[float, float]:
    """Return messages and bytes per second between clusters."""
    return (
        facts.per_s(sum(one.messages for one in facts.crossings)) or 0.0,
        facts.per_s(sum(one.size_bytes for one in facts.crossings)) or 0.0,
    )


def _load(traced: TracedFacts | None) -> Iterator[str]:
    if traced is None or not traced.cores:
        return
    busiest = max(traced.cores, key=lambda one: one.cpu_share)
    share = f"{busiest.cpu_share:.0%} of a CPU"
    if busiest.cpu_share > 1:
        yield f"{busiest.core} is overloaded with {share}"
    else:
        yield f"the busiest core is {busiest.core} with {share}"
    if traced.not_traced:
        yield f"the trace has no message of {listed(traced.not_traced, _MAX_NAMES)}"


def _unknown(facts: Facts) -> Iterator[str]:
    if facts.unknown:
        without = "" if facts.traced else " without a trace"
        yield f"the topics of {listed(facts.unknown, _MAX_NAMES)} are not known{without}"


def as_data(facts: Facts) -> dict[str, Any]:
    """Return the facts as JSON data; rates and loads are null without a trace."""
    traced = facts.traced
    messages, size_bytes = totals(facts) if traced else (None, None)
    return {
        "verdict": verdict(facts),
        "memory": fit_of(facts),
        "topics": len(facts.topics),
        "crossing_topics": len(facts.crossing_topics),
        "messages_per_s": messages,
        "bytes_per_s": size_bytes,
        "crossings": [_crossing_row(facts, one) for one in facts.crossings],
        "growing_topics": dict(facts.growing),
        "unknown_nodes": list(facts.unknown),
        "trace": _traced_row(traced) if traced else None,
    }


def _crossing_row(facts: Facts, one: Crossing) -> dict[str, Any]:
    return {
        "topic": one.topic,
        "publisher_cluster": one.publisher_cluster,
        "receiver_cluster": one.receiver_cluster,
        "messages_per_s": facts.per_s(one.messages),
        "bytes_per_s": facts.per_s(one.size_bytes),
    }


def _traced_row(traced: TracedFacts) -> dict[str, Any]:
    return {
        "duration_s": traced.recorded.seconds,
        "lost_events": traced.recorded.trace.lost,
        "cores": [
            {
                "cluster": one.core.cluster,
                "core": one.core.core,
                "nodes": list(one.nodes),
                "cpu_share": one.cpu_share,
            }
            for one in traced.cores
        ],
        "receive_threads": [vars(one) for one in traced.receive_threads],
        "not_traced": list(traced.not_traced),
        "peak_smem_bytes": dict(traced.peak_smem_bytes),
    }
