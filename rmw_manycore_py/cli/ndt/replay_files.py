# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Output files of `manycore ndt replay`, and their options."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import click

from rmw_manycore_py.cli.common.output_file import OutputFile, writing
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.table import write_csv
from rmw_manycore_py.ndt.replay.tally import Tally
from rmw_manycore_py.ndt.replay.trajectories import write_kitti, write_tum
from rmw_manycore_py.picture.plotting import load_figure

PICTURES = (".png", ".svg", ".pdf")

F = TypeVar("F", bound=Callable[..., Any])


def output_options(command: F) -> F:
    """Add one option per field of ReplayFiles."""
    pictures = ", ".join(PICTURES)
    options = [
        ("csv", (), "Write one row per scan: pose, covariance, scores, latency, outcome."),
        ("tum", (), "Write poses in TUM format, and the reference to FILE-reference."),
        ("kitti", (), "The same in KITTI format: a line per scan, nan where there is no pose."),
        ("plot", PICTURES, f"Plot map, path, errors, scores and latencies ({pictures})."),
        ("picture", PICTURES, f"Draw map, path and a scan in 3D ({pictures})."),
    ]
    for name, suffixes, text in reversed(options):
        option = click.option(f"--{name}", f"{name}_path", type=OutputFile(*suffixes), help=text)
        command = option(command)
    return command


@dataclass(frozen=True)
class ReplayFiles:
    """Paths of the output files; None skips the file."""

    csv_path: Path | None
    tum_path: Path | None
    kitti_path: Path | None
    plot_path: Path | None
    picture_path: Path | None

    def check(self) -> None:
        """Raise ManycoreError if pictures are wanted and cannot be drawn."""
        if self.plot_path is not None or self.picture_path is not None:
            load_figure()

    def write(self, tally: Tally, drive: Recording, points: Points | None) -> None:
        """Write all requested files; `points` (N, 3) is the map."""
        for path, write in (
            (self.csv_path, write_csv),
            (self.tum_path, write_tum),
            (self.kitti_path, write_kitti),
        ):
            if path is not None:
                with writing(path):
                    write(tally, path)
        if self.plot_path is not None:
            from rmw_manycore_py.ndt.replay.plot import plot

            with writing(self.plot_path):
                plot(tally, points, self.plot_path)
        if self.picture_path is not None:
            from rmw_manycore_py.ndt.replay.picture import draw

            with writing(self.picture_path):
                draw(tally, drive, points, self.picture_path)
