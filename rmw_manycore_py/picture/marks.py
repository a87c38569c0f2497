# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What of the picture changes from look to look: classes, texts and widths of its elements."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rmw_manycore_py.look.latency import TopicLatency
from rmw_manycore_py.look.loads import Loads, TopicLoad
from rmw_manycore_py.look.watch import Look
from rmw_manycore_py.picture.arcs import Arc
from rmw_manycore_py.picture.layout import Cell, ClusterBox, Layout
from rmw_manycore_py.picture.texts import bytes_text, percent_text, rate_text, time_text

# Attributes of an element by its id; "text" is its content, "rate" for moving messages.
Mark = dict[str, str | float]
Marks = dict[str, Mark]
CPU_LEVELS = 9
RATE_LEVELS = 5
_FULL = 0.9  # share of a queue or of SMEM that is shown as nearly full


def marks_of(look: Look, layout: Layout, arcs: tuple[Arc, ...]) -> Marks:
    """Return all marks of this moment."""
    marks: Marks = {}
    rates_hz = look.loads.receive_thread_rates_hz()
    for box in layout.clusters:
        marks.update(_of_cluster(look.loads, box, rates_hz.get(box.id, 0.0)))
    for cell in layout.cells:
        marks.update(_of_cell(look.loads, cell))
    topics = look.loads.topics
    for arc in arcs:
        load = topics.get(arc.topic)
        if load is not None:
            marks.update(_of_topic(arc, load, look.latencies.get(arc.topic)))
    return marks


def changed(before: Marks, after: Marks) -> Marks:
    """Return the marks that are not as they were."""
    return {own_id: mark for own_id, mark in after.items() if before.get(own_id) != mark}


def level(share: float, levels: int) -> int:
    """Return how much of 1.0 a share is, in whole levels; 0 only for nothing at all."""
    return min(math.ceil(share * levels), levels) if share > 0.0005 else 0


def _of_cluster(loads: Loads, box: ClusterBox, rate_hz: float) -> Iterator[tuple[str, Mark]]:
    found = [cluster for cluster in loads.after.clusters if cluster.id == box.id]
    if not found:
        return
    (cluster,) = found
    share = cluster.used_bytes / cluster.smem_bytes if cluster.smem_bytes else 0.0
    state = "full" if share >= _FULL else "room"
    used = f"SMEM {bytes_text(cluster.used_bytes)} of {bytes_text(cluster.smem_bytes)}"
    yield f"k{box.id}-fill", {"class": f"fill {state}", "width": round(box.smem.width * share, 1)}
    yield f"k{box.id}-smem", {"text": used}
    cpu = loads.cpu_share(cluster.receive_thread_pid)
    text = f"receive thread: {rate_text(rate_hz)}, {percent_text(cpu)}"
    life = f"cpu{level(cpu, CPU_LEVELS)}" if cluster.alive else "dead"
    yield f"k{box.id}-rt", {"class": f"receive {life}"}
    yield f"k{box.id}-rt-text", {"text": text if cluster.alive else "receive thread: not running"}


def _of_cell(loads: Loads, cell: Cell) -> Iterator[tuple[str, Mark]]:
    is_dead = any(node.is_dead for node in cell.nodes)
    cpu = sum(loads.cpu_share(member.pid) for member in cell.members)
    state = "cell" if cell.members else "cell free"
    yield cell.id, {"class": f"{state} cpu{level(cpu, CPU_LEVELS)}{' dead' if is_dead else ''}"}
    yield f"{cell.id}-cpu", {"text": percent_text(cpu) if cell.members else ""}
    for pid in cell.workers:
        yield f"w{pid}", {"class": f"worker cpu{level(loads.cpu_share(pid), CPU_LEVELS)}"}


def _of_topic(
    arc: Arc, load: TopicLoad, latency: TopicLatency | None
) -> Iterator[tuple[str, Mark]]:
    words = ["topic", f"rate{_rate_level(load.rate_hz)}"]
    if load.losses_per_s > 0:
        words.append("losing")
    if load.fill >= _FULL:
        words.append("full")
    yield arc.id, {"class": " ".join(words), "rate": float(f"{load.rate_hz:.2g}")}
    yield f"{arc.id}-label", {"text": topic_text(load, latency)}


def topic_text(load: TopicLoad, latency: TopicLatency | None) -> str:
    """Return what stands beside a topic's arc."""
    parts = [rate_text(load.rate_hz)]
    if load.rate_hz:
        parts.append(bytes_text(load.message_bytes))
    if latency is not None:
        parts.append(f"p99 {time_text(latency.p99_us)}")
    if load.queued:
        parts.append(f"queue {load.queued}/{load.capacity}")
    if load.lost:
        parts.append(f"{load.lost} lost")
    return " · ".join(parts)


def _rate_level(rate_hz: float) -> int:
    """Return 0 for nothing, 1 up to 1 Hz, and one more for each factor of 10."""
    return 0 if rate_hz <= 0 else max(1, min(1 + math.ceil(math.log10(rate_hz)), RATE_LEVELS))
