# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""State of the picture that changes between looks: classes, texts and widths of elements."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache

from rmw_manycore_py.picture.arcs import LOAD_LENGTH
from rmw_manycore_py.picture.layout import Cell, ClusterBox, Layout
from rmw_manycore_py.picture.texts import bytes_text, percent_text, rate_text, time_text
from rmw_manycore_py.platform.monitor.latency import TopicLatency
from rmw_manycore_py.platform.monitor.loads import Loads, TopicLoad
from rmw_manycore_py.platform.monitor.watch import Look

# Attributes of an element by id; "text" is its content, "rate" the speed of moving messages.
Mark = dict[str, str | float]
Marks = dict[str, Mark]
CPU_LEVELS = 9
RATE_LEVELS = 5
_FULL = 0.9  # fill level of a queue or SMEM shown as nearly full


def marks_of(look: Look, layout: Layout) -> Marks:
    """Return all marks of a look."""
    marks: Marks = {}
    rates_hz = look.loads.receive_thread_rates_hz()
    for box in layout.clusters:
        marks.update(_of_cluster(look.loads, box, rates_hz.get(box.id, 0.0)))
    for cell in layout.cells:
        marks[cell.id], marks[cell.cpu_id] = _of_core(look.loads, cell)
        for pid in cell.plan.workers:
            share = look.loads.cpu_share(pid)
            marks[f"w{pid}"] = {"class": f"worker cpu{level(share, CPU_LEVELS)}"}
    topics = look.loads.rounded_topics
    for arc in layout.arcs:
        loads = [topics[name] for name in arc.wire.topics if name in topics]
        if loads:
            latencies = (look.latencies.get(name) for name in arc.wire.topics)
            marks[arc.id], marks[arc.label_id] = _topic_marks(
                _together(loads), next(filter(None, latencies), None)
            )
    return marks


def changed(before: Marks, after: Marks) -> Marks:
    """Return the marks that differ."""
    return {
        own_id: mark
        for own_id, mark in after.items()
        if (earlier := before.get(own_id)) is not mark and earlier != mark
    }


def level(share: float, levels: int) -> int:
    """Return the level of a share of 1.0; 0 only if the share is zero."""
    return min(math.ceil(share * levels), levels) if share > 0.0005 else 0


def _of_cluster(loads: Loads, box: ClusterBox, rate_hz: float) -> Iterator[tuple[str, Mark]]:
    found = [cluster for cluster in loads.after.clusters if cluster.id == box.id]
    if not found:
        return
    (cluster,) = found
    share = cluster.used_bytes / cluster.smem_bytes if cluster.smem_bytes else 0.0
    state = "full" if share >= _FULL else "room"
    used = f"SMEM {bytes_text(cluster.used_bytes)}"
    if cluster.smem_bytes:
        used += f" of {bytes_text(cluster.smem_bytes)}"
    yield f"k{box.id}-fill", {"class": f"fill {state}", "width": round(box.smem.width * share, 1)}
    yield f"k{box.id}-smem", {"text": used}
    cpu = loads.cpu_share(cluster.receive_thread_pid)
    text = f"receive thread: {rate_text(rate_hz)}, {percent_text(cpu)}"
    life = f"cpu{level(cpu, CPU_LEVELS)}" if cluster.alive else "dead"
    yield f"k{box.id}-rt", {"class": f"receive {life}"}
    yield f"k{box.id}-rt-text", {"text": text if cluster.alive else "receive thread: not running"}


def _of_core(loads: Loads, cell: Cell) -> tuple[Mark, Mark]:
    living = cell.plan.living
    cpu = sum([loads.cpu_share(member.pid) for member in living])
    percent = percent_text(cpu) if living else ""
    return _core_marks(level(cpu, CPU_LEVELS), bool(cell.plan.dead), percent)


# Marks depend on few values, and most elements stay unchanged: each mark is made once.
@lru_cache(maxsize=1024)
def _core_marks(cpu_level: int, is_dead: bool, percent: str) -> tuple[Mark, Mark]:
    """Return the marks of a core and of its CPU usage."""
    return {"class": f"cell cpu{cpu_level}{' dead' if is_dead else ''}"}, {"text": percent}


@lru_cache(maxsize=8192)
def _topic_marks(load: TopicLoad, latency: TopicLatency | None) -> tuple[Mark, Mark]:
    """Return the marks of an arc and of its label."""
    words = ["topic", f"rate{_rate_level(load.rate_hz)}"]
    if load.losses_per_s > 0:
        words.append("losing")
    if load.fill >= _FULL:
        words.append("full")
    curve: Mark = {"class": " ".join(words), "rate": float(f"{load.rate_hz:.2g}")}
    return curve, {"text": label_text(load, latency)}


def label_text(load: TopicLoad, latency: TopicLatency | None) -> str:
    """Return the label of a topic's arc: of its load what has room, losses first."""
    first, *parts = _parts(load, latency)
    text = first
    for part in sorted(parts, key=lambda one: not one.endswith("lost")):
        if len(text) + len(part) + 3 <= LOAD_LENGTH:
            text = f"{text} · {part}"
    return text


def topic_text(load: TopicLoad, latency: TopicLatency | None) -> str:
    """Return the load of a topic in words."""
    return " · ".join(_parts(load, latency))


def _parts(load: TopicLoad, latency: TopicLatency | None) -> list[str]:
    parts = [rate_text(load.rate_hz)]
    if load.rate_hz:
        parts.append(bytes_text(load.message_bytes))
    if latency is not None:
        parts.append(f"p99 {time_text(latency.p99_us)}")
    if load.queued:
        parts.append(f"queue {load.queued}/{load.capacity}")
    if load.lost:
        parts.append(f"{load.lost} lost")
    return parts


def _together(loads: Sequence[TopicLoad]) -> TopicLoad:
    """Return the load of topics that are drawn as one."""
    if len(loads) == 1:
        return loads[0]
    fullest = max(loads, key=lambda load: load.fill)
    return fullest._replace(
        rate_hz=sum(load.rate_hz for load in loads),
        bytes_per_s=sum(load.bytes_per_s for load in loads),
        lost=sum(load.lost for load in loads),
        superseded=sum(load.superseded for load in loads),
        losses_per_s=sum(load.losses_per_s for load in loads),
    )


def _rate_level(rate_hz: float) -> int:
    """Return 0 for no messages, 1 up to 1 Hz, plus one per factor of 10."""
    return 0 if rate_hz <= 0 else max(1, min(1 + math.ceil(math.log10(rate_hz)), RATE_LEVELS))
