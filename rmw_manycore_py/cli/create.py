# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore create`: the create.py of ROS-lite2."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import (
    echo,
    new_table,
    print_json,
    print_notices,
    print_table,
)
from rmw_manycore_py.create import create
from rmw_manycore_py.create.figure import (
    FILE,
    LINE,
    MAX_NODES,
    PAPERS_REDUCTION,
    Dot,
    by_hand,
    dot_of,
    draw,
)
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import as_data
from rmw_manycore_py.mapfile.installed import installed_mapfiles
from rmw_manycore_py.mapfile.placing.show import rules_in_words
from rmw_manycore_py.picture.plotting import load_figure
from rmw_manycore_py.platform.topology import as_host_cpu, host_cpu_text

_EXAMPLES = examples(
    "manycore create talker_listener -o generated",
    "manycore create autoware_reference -o generated --report --compare",
)


@click.command("create", epilog=_EXAMPLES)
@mapfile_argument()
@click.option(
    "-o",
    "--output",
    "directory",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Directory to write to; may hold the output of an earlier `create`.",
)
@click.option(
    "--report",
    "with_figure",
    is_flag=True,
    help="Report the lines that MAPFILE saves: a table, and Fig. 12 of ROS-lite2 in DIRECTORY.",
)
@click.option("--compare", is_flag=True, help="With --report: also the installed mapfiles.")
@json_option
def command(
    mapfile: Path, directory: Path, with_figure: bool, compare: bool, as_json: bool
) -> None:
    """Generate topic table, launch scripts, parameters.

    And a report on the memory that the nodes of MAPFILE will take.
    """
    if compare and not with_figure:
        raise click.UsageError("--compare belongs to --report.")
    if with_figure:
        load_figure()
    report = create(mapfile, directory)
    dots = _draw_figure(mapfile, directory, compare=compare) if with_figure else []
    if as_json:
        data = as_data(report.placement)
        print_json(
            {
                "directory": report.directory,
                "files": report.files,
                "written_lines": report.written_lines,
                "generated_lines": report.generated_lines,
                "delta_loc": report.delta_loc,
                "bridge": data["bridge"],
                "nodes": data["nodes"],
                "figure": [{**asdict(dot), "reduction": dot.reduction} for dot in dots],
            }
        )
        return
    print_notices(report.placement.notices)
    for file in report.files:
        echo(file)
    echo(report.summary)
    for node in report.placement.nodes:
        for rule in rules_in_words(node):
            echo(f"{node.full_name}: {rule}")
    if bridge := report.placement.bridge:
        cpus = host_cpu_text(as_host_cpu(bridge.host_cpus))
        echo(f"bridge: {len(bridge.routes)} routes, host CPU {cpus}")
    if dots:
        _print_figure(dots, directory / FILE)


def _draw_figure(mapfile: Path, directory: Path, *, compare: bool) -> list[Dot]:
    """Plot this mapfile, and the installed ones that are valid here to compare it with."""
    dots = [dot_of(mapfile)]
    for installed in installed_mapfiles().values() if compare else ():
        if not installed.samefile(mapfile):
            with suppress(ManycoreError):
                dots.append(dot_of(installed))
    draw(dots, directory / FILE)
    return dots


def _print_figure(dots: Sequence[Dot], file: Path) -> None:
    table = new_table("mapfile", "#nodes", "#lines by hand", "#lines of it", "#less")
    for dot in dots:
        table.add_row(
            dot.name,
            str(dot.nodes),
            str(dot.delta_loc),
            str(dot.written_lines),
            f"{dot.reduction:.0%}",
        )
    echo()
    print_table(table)
    echo(
        f"{LINE}: {by_hand()[-1]:,} lines for {MAX_NODES} nodes. "
        f"ROS-lite2 reports {PAPERS_REDUCTION:.0%} less for its set of nodes."
    )
    echo(file)
