# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore demo --compare`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from rmw_manycore_py.bench.cameras import CAMERAS, IMAGES, Detections, compare
from rmw_manycore_py.bench.plot import plot
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.cli.common.printing import echo, new_table, print_table
from rmw_manycore_py.picture.plotting import load_figure


def compare_cameras(picture: Path | None) -> None:
    """Count detections with each middleware, print them and draw them."""
    if picture is not None:
        load_figure()
    progress = Console(stderr=True)
    with progress.status("demo") as status:
        found = list(compare(status.update))
    echo(f"{IMAGES} images through three nodes of rclpy: camera, filter, detector. Beside them:")
    for camera in CAMERAS:
        loops = f"{camera.loops_per_cpu} endless loops for each CPU"
        echo(f"  {camera.name}: {loops if camera.loops_per_cpu else 'nothing'}")
    _show(found)
    if picture is not None:
        plot([_result(one) for one in found], picture)
        progress.print(f"wrote {picture}")


def _show(found: Sequence[Detections]) -> None:
    table = new_table("images", "middleware", "#detections", "#median age")
    for one in found:
        age = f"{one.age_ms:.0f} ms" if one.arrived else "-"
        table.add_row(one.camera, one.middleware, f"{one.arrived} of {one.images}", age)
    print_table(table)


def _result(one: Detections) -> Result:
    question = f"detections of {one.images} images, {one.camera}"
    return Result(question, one.middleware, "detections", (float(one.arrived),), True)
