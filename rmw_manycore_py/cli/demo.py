# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore demo`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from rmw_manycore_py.cli.cameras import compare_cameras
from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.common.printed_run import print_run
from rmw_manycore_py.cli.common.printing import echo, new_table, print_table
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.launch.run import Mode, Run
from rmw_manycore_py.mapfile import Placement, load_mapfile, resolve
from rmw_manycore_py.mapfile.installed import description, installed_mapfiles

DEFAULT = "talker_listener"
DEFAULT_DURATION_S = 10.0


@click.command(
    "demo",
    epilog=examples(
        "manycore demo",
        "manycore demo image_pipeline --duration 5",
        "manycore demo --list",
        "manycore demo --compare",
    ),
)
@mapfile_argument("[NAME]", DEFAULT)
@duration_option(DEFAULT_DURATION_S)
@click.option("--list", "as_list", is_flag=True, help="List the installed mapfiles and exit.")
@click.option(
    "--compare",
    "is_comparison",
    is_flag=True,
    help="Count images that arrive, here and with Fast DDS (2 min).",
)
@click.option(
    "--plot", "picture", type=OutputFile(".png", ".svg", ".pdf"), help="Draw what --compare found."
)
def command(
    mapfile: Path, duration_s: float, as_list: bool, is_comparison: bool, picture: Path | None
) -> None:
    """Run an installed mapfile for some seconds.

    Then suggest what to try next. NAME defaults to talker_listener. With --compare, count how many
    images of two cameras get through a filter to a detector on a busy machine: two minutes.
    """
    if picture is not None and not is_comparison:
        raise click.UsageError("--plot requires --compare")
    if is_comparison:
        compare_cameras(picture)
        return
    if as_list:
        _list()
        return
    loaded = load_mapfile(mapfile)
    placement = resolve(loaded)
    echo(f"{mapfile}: {description(mapfile)}\n")
    run = Run(placement, Mode(loaded))
    exit_status = print_run(run, RunPrinter(run.program_names).report, duration_s)
    if exit_status == 0:
        _explain(mapfile, placement)
    sys.exit(exit_status)


def _list() -> None:
    table = new_table("name", "what it runs")
    for name, mapfile in installed_mapfiles().items():
        table.add_row(name, description(mapfile))
    print_table(table)


def _explain(mapfile: Path, placement: Placement) -> None:
    echo("\nEach node was a process of its own, pinned to the host CPU of its core:")
    for node in placement.nodes:
        place = f"cluster {node.cluster}, core {node.core}, host CPU {node.host_cpu}"
        echo(f"  {node.full_name}: {place}")
    names = {file: name for name, file in installed_mapfiles().items()}
    name = names.get(mapfile, str(mapfile))
    topic = next((topic.name for topic in placement.topics), "TOPIC")
    commands = {
        f"manycore map show {name}": "the placement, and the memory of each cluster",
        f"manycore run {name}": "the same until Ctrl-C; meanwhile, in another shell:",
        f"manycore topic echo {topic}": "the messages",
        "manycore top": "CPU, memory and queues",
        "manycore demo --list": "other mapfiles",
    }
    echo("\nNext steps:")
    width = max(map(len, commands))
    for words, purpose in commands.items():
        echo(f"  {words:<{width}}  {purpose}")
    echo(f"A mapfile to start from: {mapfile}")
