# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plot the round trips that the documentation has in its table: plot_round_trips.py FILE.svg.

The picture holds the figures as its description, so that a test sees when the table has changed.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

TABLE = Path(__file__).parents[1] / "docs/reference/benchmarks/messages.md"
HEAD = "| payload | futex + copy |"
STYLES = {
    "inside": ("rmw_manycore, inside a cluster", "tab:blue", "o-"),
    "between": ("rmw_manycore, between clusters", "tab:cyan", "o-"),
    "Fast DDS as installed": ("Fast DDS as installed", "tab:red", "s--"),
    "Fast DDS, 128 MB": ("Fast DDS, 128 MB segment", "tab:orange", "s--"),
    "futex + copy": ("futex + two copies: the machine", "tab:gray", "x:"),
}


def figures() -> dict[str, list[float]]:
    """Return the medians in microseconds of each contender, and the payloads in bytes."""
    lines = TABLE.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(HEAD))
    rows = []
    for line in (lines[start], *lines[start + 2 :]):
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip("|").split("|")])
    columns = {head: cells for head, *cells in zip(*rows, strict=True)}
    numbers = {name: [float(cell.replace(",", "")) for cell in columns[name]] for name in STYLES}
    return {"payload": [in_bytes(cell) for cell in columns["payload"]], **numbers}


def in_bytes(size: str) -> float:
    """Return a size such as "64 KiB" in bytes."""
    number, unit = size.split()
    return float(number) * {"B": 1, "KiB": 1 << 10, "MiB": 1 << 20}[unit]


def main(file: str) -> None:
    """Draw the plot into the file."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "round trips"})
    from matplotlib import pyplot

    data = figures()
    picture, axes = pyplot.subplots(figsize=(7.5, 3.8), layout="constrained")
    for name, (label, colour, style) in STYLES.items():
        axes.loglog(data["payload"], data[name], style, color=colour, label=label)
    axes.set_xticks(data["payload"], ["64 B", "64 KiB", "1 MiB", "8 MiB"], minor=False)
    axes.minorticks_off()
    axes.set_xlabel("payload")
    axes.set_ylabel("round trip, median, us")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    picture.savefig(file, metadata={"Date": None, "Description": json.dumps(data)})
    print(f"wrote {file}")


if __name__ == "__main__":
    main(*sys.argv[1:])
