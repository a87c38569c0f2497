# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Drives in virtual time on slower and slower chips, and the callback that each waits for."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from rmw_manycore_py.bench.virtual import VirtualRun, runs_of
from rmw_manycore_py.profile.recorded import profile_of
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import Trace

REPORT = "drive.json"  # of the laptop
_LAPTOP_PRINTS = "whill_laptop prints "
_LOST = ("the path is lost", "the vehicle stands")
_FAR = 0.5
_MIN_MESSAGES = 10


@dataclass(frozen=True)
class Blamed:
    """The callback that keeps a thread busy while messages wait for it longest.

    :ivar topic: of the messages that wait.
    :ivar wait_ms: median, from their publication to their callback.
    :ivar trigger: topic of the callback that takes most of that node's time, or `timer`.
    :ivar share: of the time that it runs.
    """

    node: str
    topic: str
    wait_ms: float
    trigger: str
    share: float


@dataclass(frozen=True)
class Drive:
    """A drive on a chip whose cores have a speed relative to the machine of the profile."""

    speed: float
    driven_m: float
    lateral_m_max: float
    end: str
    blamed: Blamed

    def is_lost(self, fastest_m: float) -> bool:
        """Whether the vehicle left the path, stood, or came less than half as far as another."""
        return self.end.startswith(_LOST) or self.driven_m < _FAR * fastest_m


def sweep(
    mapfile: Path,
    profile: Path,
    platform: str,
    speeds: Sequence[float],
    duration_s: float,
    timeout_s: float,
) -> Iterator[Drive]:
    """Yield a drive for each speed.

    :param mapfile: of a course, with the laptop as a node.
    :raises ManycoreError: if a run fails.
    """
    for speed in speeds:
        with TemporaryDirectory() as name:
            target = Path(name) / "target.yaml"
            parameters = {"speed": {"value": speed, "source": "chosen"}}
            target.write_text(json.dumps({"base": platform, "parameters": parameters}))
            options = ("--profile", str(profile), "--platform", str(target))
            (run,) = runs_of(mapfile, options, 1, duration_s, timeout_s)
        figures: dict[str, Any] = json.loads((mapfile.parent / REPORT).read_text())
        blame = blamed_in(run.trace)
        yield Drive(speed, figures["driven_m"], figures["lateral_m_max"], _end_of(run), blame)


def _end_of(run: VirtualRun) -> str:
    said = [one for one in run.printed if one.startswith(_LAPTOP_PRINTS)]
    return said[-1].removeprefix(_LAPTOP_PRINTS) if said else "drives on"


def blamed_in(trace: Trace) -> Blamed:
    """Return the callback to blame for the longest waits of a trace."""
    messages = Messages(trace)
    waits_ns: dict[tuple[str, str], list[int]] = defaultdict(list)
    for topic, arrivals in messages.arrivals.items():
        for one in arrivals:
            if (published_ns := messages.published_ns.get(one.record)) is not None:
                waits_ns[one.node, topic].append(one.callback_ns - published_ns)
    medians = {key: median(own) for key, own in waits_ns.items() if len(own) >= _MIN_MESSAGES}
    (node, topic), wait_ns = max(medians.items(), key=lambda one: (one[1], one[0]))
    times_ns = messages.published_ns.values()
    profile = profile_of(trace, min(times_ns), max(times_ns))
    shares = {
        callback.trigger or "timer": (callback.rate_hz or 0.0) * callback.wall_ns.mean / 1e9
        for callback in profile.callbacks
        if callback.node is not None
        and profile.nodes[callback.node].name == node
        and callback.wall_ns is not None
    }
    trigger, share = max(shares.items(), key=lambda one: one[1])
    return Blamed(node, topic, wait_ns / 1e6, trigger, share)
