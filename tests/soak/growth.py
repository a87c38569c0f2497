# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Judge and draw whether a value grew over a soak."""

from __future__ import annotations

import csv
from pathlib import Path
from statistics import median

from rmw_manycore_py.picture.plotting import load_figure
from soak.holdings import Holdings

# Python's and glibc's heaps settle late; everything else returns to exactly its former value.
# Topic DSMs follow their messages, whose sizes are random. Freed blocks below `min_hole_bytes` keep
# their pages until a larger block over them is freed: how many they are differs from rest to rest,
# below the address up to which the SMEM was ever in use.
TOLERATED = {"private_bytes": 1.1, "backed_bytes": 1.3, "smem_used_bytes": 1.1}
# Threads and descriptors fluctuate with a receive thread that has just been replaced.
SETTLING = 2


def grown(rests: list[Holdings]) -> list[str]:
    """Return what is higher in the last third of the rests than in the first, and by how much."""
    settled = rests[SETTLING:] if len(rests) > 3 * SETTLING else rests
    third = max(len(settled) // 3, 1)
    found = []
    for name in Holdings.names():
        early = median(getattr(rest, name) for rest in settled[:third])
        late = median(getattr(rest, name) for rest in settled[-third:])
        if late > early * TOLERATED.get(name, 1.0):
            found.append(f"{name} grew from {early:g} to {late:g}")
    return found


class Record:
    """All samples of the platform, appended to a table at once, so that a stop loses nothing."""

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        self._directory = directory
        self._rows: list[tuple[float, bool, Holdings]] = []
        self._file = (directory / "soak.csv").open("w", newline="")
        self._table = csv.writer(self._file)
        self._table.writerow(["time_s", "at_rest", *Holdings.names()])

    def add(self, time_s: float, at_rest: bool, holdings: Holdings) -> None:
        self._rows.append((time_s, at_rest, holdings))
        values = [getattr(holdings, name) for name in Holdings.names()]
        self._table.writerow([f"{time_s:.1f}", int(at_rest), *values])
        self._file.flush()

    def rests(self) -> list[Holdings]:
        return [holdings for _, at_rest, holdings in self._rows if at_rest]

    def draw(self) -> Path:
        """Plot every quantity over time: under churn and at rest."""
        names = Holdings.names()
        figure = load_figure()(figsize=(9, 1.6 * len(names)), layout="constrained")
        for axes, name in zip(figure.subplots(len(names), sharex=True), names, strict=True):
            for wanted, style in ((False, "C0,"), (True, "C1.-")):
                rows = [(t, getattr(h, name)) for t, at_rest, h in self._rows if at_rest is wanted]
                axes.plot([t / 60 for t, _ in rows], [v for _, v in rows], style)
            axes.set_ylabel(name, fontsize=7)
            axes.set_ylim(bottom=0)
        axes.set_xlabel("minutes; orange: at rest")
        path = self._directory / "soak.png"
        figure.savefig(path, dpi=100)
        return path
