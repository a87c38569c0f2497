# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Claims of section IV of ROS-lite about its figures, as functions of medians."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise

from rmw_manycore_py.bench.relations import Claim, Found, side
from rmw_manycore_py.papers.roslite.bench import end_to_end, memory, sending, split

# By question and contender; KeyError for what was not measured.
Medians = Mapping[tuple[str, str], float]

SIMILAR = 1.15
FASTER = 1.02
FIFTY = (25.0, 100.0)  # "about 50 times"
PASSES = 5.0
LIGHT = ("pure_pursuit", "twist_filter")


def light_similar(medians: Medians) -> Found:
    """Messages and sessions take the same for light data."""
    ratios = [_message_to_session(medians, node, n) for node in LIGHT for n in sending.LANES]
    worst = max(ratios, key=lambda ratio: max(ratio, 1 / ratio))
    return side(
        worst, min_value=1 / SIMILAR, max_value=SIMILAR
    ), f"message / session {_range(ratios)}"


def heavy_faster(medians: Medians) -> Found:
    """Sessions are faster than messages for whole lanes."""
    ratios = [_message_to_session(medians, "lane_select", n) for n in sending.LANES]
    found = " and ".join(f"{ratio:.2f}" for ratio in ratios)
    return side(min(ratios), min_value=FASTER), f"message / session {found} for whole lanes"


def _message_to_session(medians: Medians, node: str, waypoints: int) -> float:
    question = sending.question_of(node, waypoints)
    return medians[question, "message"] / medians[question, "session"]


def fifty_times(medians: Medians) -> Found:
    """Compare the localizer in parts with the one that is alone."""
    alignment = end_to_end.ALIGNMENT
    ratio = medians[alignment, end_to_end.BEFORE] / medians[alignment, end_to_end.AFTER]
    found = f"x {ratio:.2f}, here against one process that has the whole map"
    return side(ratio, min_value=FIFTY[0], max_value=FIFTY[1]), found


def scales(medians: Medians) -> Found:
    """Each further cluster of derivatives shortens a pass."""
    steps, ends = [], []
    for searches in split.SEARCHES:
        times = [medians[split.QUESTION, split.contender(n, searches)] for n in split.DERIVATIVES]
        steps += [before / after for before, after in pairwise(times)]
        ends.append(f"{times[0]:.2f} to {times[-1]:.2f} ms with {searches} of radius_search")
    return side(min(steps), min_value=FASTER), "; ".join(ends)


def converges(medians: Medians) -> Found:
    """Alignments usually end within five passes."""
    passes = medians[end_to_end.PASSES, end_to_end.AFTER]
    return side(passes, max_value=PASSES), f"{passes:g} passes (median)"


def shorter(medians: Medians) -> Found:
    """Parallelization shortens the way from scan to command."""
    command = end_to_end.COMMAND
    before, after = medians[command, end_to_end.BEFORE], medians[command, end_to_end.AFTER]
    ratio = before / after
    return side(ratio, min_value=FASTER), f"{before:.1f} to {after:.1f} ms, x {ratio:.2f}"


def in_time(medians: Medians) -> Found:
    """After parallelization each command comes within 100 ms."""
    late = medians[end_to_end.LATE, end_to_end.AFTER]
    return side(late, max_value=0.0), f"{late:g} scans late or lost"


def room_left(medians: Medians) -> Found:
    """About half of a cluster's memory is left for topics."""
    left = medians[memory.SMEM, memory.LEFT]
    return side(left, min_value=memory.LEFT_KIB), f"{left:.0f} KiB of 2,048"


def _range(ratios: list[float]) -> str:
    return f"{min(ratios):.2f} to {max(ratios):.2f}"


_CLAIMS: tuple[tuple[str, str, Callable[[Medians], Found]], ...] = (
    ("Fig. 13a", "light data: message and session almost the same", light_similar),
    ("Fig. 13b", "heavy data: session faster than message", heavy_faster),
    ("Fig. 14", "localizer about 50 times faster than related work", fifty_times),
    ("Fig. 15a", "a pass scales with clusters of derivatives", scales),
    ("Fig. 15b", "an alignment converges within five passes", converges),
    ("Fig. 16a", "parallelized, the pipeline is faster", shorter),
    ("Fig. 16b", "parallelized, it meets 100 ms", in_time),
    ("Table I", "1 MB of 2 MB is left for topic data", room_left),
)
CLAIMS: tuple[Claim[Medians], ...] = tuple(Claim(*claim) for claim in _CLAIMS)
