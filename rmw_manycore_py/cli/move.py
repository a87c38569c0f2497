# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore move`."""

from __future__ import annotations

import sys

import click

from rmw_manycore_py.cli.common.completion import complete_nodes_of_runs
from rmw_manycore_py.cli.common.node_watch import NodeWatch, checked_answer
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.runs import living_runs, nodes_by_run
from rmw_manycore_py.launch.runs.client import Client


def _place(_context: click.Context, _argument: click.Parameter, text: str) -> dict[str, int]:
    numbers = text.split(":")
    if len(numbers) > 2 or not all(one.isascii() and one.isdecimal() for one in numbers):
        raise click.BadParameter(f"expected a cluster such as 2, or a core as 2:3, found '{text}'")
    return dict(zip(("cluster", "core"), map(int, numbers), strict=False))


@click.command("move", epilog=examples("manycore move listener 2", "manycore move listener 2:3"))
@click.argument("node", shell_complete=complete_nodes_of_runs)
@click.argument("place", callback=_place, metavar="CLUSTER[:CORE]")
@platform_option
def command(node: str, place: dict[str, int], platform: str) -> None:
    """Restart NODE on another core.

    Without CORE, on the first free core of CLUSTER. The place is checked as by `manycore map
    check`: the core has to be free, and the cluster to have the memory. The mapfile is left as it
    is; the command names the line to edit. The next `manycore up -d MAPFILE` moves NODE back,
    unless the mapfile names the new place.
    """
    ((run, (name,)),) = nodes_by_run(living_runs(platform), [node])
    with Client(run, "move", node=name, **place) as client:
        answer = checked_answer(client)
        sys.exit(NodeWatch(run, answer["starts"], answer["ends"]).follow(client))
