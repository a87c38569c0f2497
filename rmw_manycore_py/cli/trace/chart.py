# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bar chart of the latency of chains."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.picture.plotting import load_figure
from rmw_manycore_py.trace.latency import ChainLatency

_HOPS = ("bridge", "communication", "node")


def plot(chains: Sequence[ChainLatency], path: Path) -> None:
    """Draw a stacked bar per chain from the medians of its hops."""
    figure = load_figure()(figsize=(10, 1.5 + len(chains)), layout="constrained")
    axes = figure.subplots()
    for row, one in enumerate(chains):
        left_us = 0.0
        for part in one.parts:
            if part.name.split()[0] in _HOPS:
                length_us = part.quantile(0.5)
                axes.barh(row, length_us, left=left_us, label=part.name)
                left_us += length_us
    axes.set_yticks(range(len(chains)), [" ".join(one.chain) for one in chains])
    axes.set_xlabel("median, us")
    figure.legend(loc="outside upper center", ncols=3, fontsize="small")
    with writing(path):
        figure.savefig(path)
