# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench whill`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.papers.roslite2.bench import drive_question, fault_question


@click.command(
    "whill",
    epilog=examples(
        "manycore whill course build/whill",
        "manycore bench whill --rounds 1",
        "manycore bench whill --rounds 1 --only drive:",
        "manycore bench whill --rounds 1 --only 'faults: kill -9 ekf_localizer'",
    ),
)
@click.option(
    "--course",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("build/whill"),
    show_default=True,
    help="Directory written by 'manycore whill course'.",
)
@click.option(
    "--netns",
    "namespace",
    metavar="NAME",
    help="Run the nodes in this network namespace and count its incoming packets.",
)
@bench_options
def command(course: Path, namespace: str | None, **options: Any) -> None:
    """Drive the wheelchair, and measure it.

    Off-loaded, on plain Fast DDS, and with a fault in each process. A round consists of 15
    drives over the whole course; each takes two minutes on the default one.
    """
    answer([drive_question(course, namespace), fault_question(course)], **options)
