# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore whill sweep`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import new_table, print_json, print_table
from rmw_manycore_py.papers.roslite2.laptop.sweep import Drive, sweep


@click.command(
    "sweep",
    epilog=examples(
        "manycore whill sweep --course build/whill",
        "manycore whill sweep --course build/whill --factor 1 --factor 4 --duration 30",
    ),
)
@click.option(
    "--course",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    default=Path("build/whill"),
    show_default=True,
    help="Directory written by 'manycore whill course'.",
)
@click.option(
    "--factor",
    "factors",
    type=FiniteRange(min=0, min_open=True),
    multiple=True,
    default=(1.0, 2.0, 4.0, 8.0),
    show_default=True,
    help="How many times longer callbacks take on the chip. May be repeated.",
)
@duration_option(60.0, "Length of a drive, in virtual time.")
@json_option
def command(course: Path, factors: tuple[float, ...], duration_s: float, as_json: bool) -> None:
    """Drive on slower and slower chips, in virtual time.

    Shows from which factor on the path is lost, and which callback is busiest then. The factor
    multiplies the CPU time that callbacks take on this machine.
    """
    drives = list(sweep(course, factors, duration_s))
    if as_json:
        print_json([_row(one) for one in drives])
        return
    table = new_table("#factor", "#driven", "#beside the path", "#scans", "#late", "busiest")
    for one in drives:
        found = one.figures
        name, share = one.busiest
        table.add_row(
            f"{one.factor:g}",
            f"{found['driven_m']:.1f} m",
            f"{found['lateral_m_max']:.2f} m",
            str(found["scans"]),
            str(found["scans_lost"] + found["scans_late"]),
            f"{name} {100 * share:.0f} %",
        )
    print_table(table)


def _row(one: Drive) -> dict[str, object]:
    return {"factor": one.factor, "busiest": one.busiest, **one.figures}
