# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore restart`."""

from __future__ import annotations

import sys

import click

from rmw_manycore_py.cli.common.completion import complete_nodes_of_runs
from rmw_manycore_py.cli.common.node_watch import NodeWatch, unapplied
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import print_notices
from rmw_manycore_py.cli.common.runs import living_runs, nodes_by_run
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory


@click.command("restart", epilog=examples("manycore restart talker", "manycore restart"))
@click.argument("nodes", nargs=-1, shell_complete=complete_nodes_of_runs)
@platform_option
def command(nodes: tuple[str, ...], platform: str) -> None:
    """Restart NODES, by default all.

    Nodes that have ended are started again. Nodes restart as their run read the mapfile, at the
    places they have; if it places them otherwise by now, a notice reports it, and `manycore up -d`
    applies it. Watches the nodes for one second; the exit status is 1 if one ends again in that
    time.
    """
    runs = living_runs(platform)
    every = [(run, [n for n in run.nodes if not n.startswith("(")]) for run in runs]
    sys.exit(max(_restart(run, names) for run, names in (nodes_by_run(runs, nodes) or every)))


def _restart(run: RunDirectory, names: list[str]) -> int:
    """Restart nodes; return the exit status."""
    print_notices(unapplied(run))
    with Client(run, "restart", nodes=names) as client:
        return NodeWatch(run, names).follow(client)
