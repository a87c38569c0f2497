# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Drives in virtual time on slower and slower chips."""

from __future__ import annotations

import json
import subprocess
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.roslite2.course.directory import VIRTUAL_MAPFILE
from rmw_manycore_py.profile.recorded import profile_of
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import load

REPORT = "drive.json"


@dataclass(frozen=True)
class Drive:
    """A drive on a chip.

    :ivar factor: by which callbacks take longer than here.
    :ivar figures: summary of the drive; scan to command in ms, errors in m.
    :ivar busiest: callback that is busy for the largest share of the time, and that share.
    """

    factor: float
    figures: Mapping[str, Any]
    busiest: tuple[str, float]


def sweep(course: Path, factors: Sequence[float], duration_s: float) -> Iterator[Drive]:
    """Yield a drive for each factor.

    :raises ManycoreError: if a run fails.
    """
    for factor in factors:
        with TemporaryDirectory() as directory:
            trace = Path(directory) / "trace.csv"
            words = ("run", str(course / VIRTUAL_MAPFILE), "--factor", f"{factor:g}", "--json")
            options = ("--duration", f"{duration_s:g}", "--trace", str(trace))
            command = own_program("rmw_manycore_py.cli", *words, *options)
            (course / REPORT).unlink(missing_ok=True)
            run = subprocess.run(command, capture_output=True, text=True, check=False)
            if run.returncode or not (course / REPORT).exists():
                raise ManycoreError(f"the drive failed: {(run.stderr or run.stdout)[-500:]}")
            figures = json.loads((course / REPORT).read_text())
            yield Drive(factor, figures, busiest(load(trace)))


def busiest(trace: Trace) -> tuple[str, float]:
    """Return the callback that is busy for the largest share of a trace, and that share.

    What a callback hands to a thread of its node, as scan matching, counts up to its publication.
    """
    loads: dict[str, float] = defaultdict(float)
    messages = Messages(trace)
    begin_ns, end_ns = min(messages.published_ns.values()), max(messages.published_ns.values())
    for record, cause in messages.causes.items():
        took_ns = messages.published_ns[record] - cause.callback_ns
        loads[f"{cause.node}: {messages.topic_of(cause.record)}"] += took_ns / (end_ns - begin_ns)
    profile = profile_of(trace, begin_ns, end_ns)
    for callback in profile.callbacks:
        if callback.node is not None and callback.wall_ns is not None:
            name = f"{profile.nodes[callback.node].name}: {callback.trigger or 'timer'}"
            share = (callback.rate_hz or 0.0) * callback.wall_ns.mean / 1e9
            loads[name] = max(loads[name], share)
    return max(loads.items(), key=lambda one: one[1])
