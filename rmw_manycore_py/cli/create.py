# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore create`: the create.py of ROS-lite2."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import print_json, print_notices
from rmw_manycore_py.create import create
from rmw_manycore_py.mapfile import as_data
from rmw_manycore_py.mapfile.placing.show import rules_in_words
from rmw_manycore_py.topology import as_host_cpu, host_cpu_text


@click.command("create", epilog=examples("manycore create talker_listener -o generated"))
@mapfile_argument()
@click.option(
    "-o",
    "--output",
    "directory",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Directory to write to; it may be one that create wrote before.",
)
@json_option
def command(mapfile: Path, directory: Path, as_json: bool) -> None:
    """Write the topic table, launch scripts, parameter files and memory use of MAPFILE."""
    report = create(mapfile, directory)
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
            }
        )
        return
    print_notices(report.placement.notices)
    for file in report.files:
        click.echo(file)
    click.echo(report.summary)
    for node in report.placement.nodes:
        for rule in rules_in_words(node):
            click.echo(f"{node.full_name}: {rule}")
    if bridge := report.placement.bridge:
        cpus = host_cpu_text(as_host_cpu(bridge.host_cpus))
        click.echo(f"bridge: {len(bridge.routes)} routes, host CPU {cpus}")
