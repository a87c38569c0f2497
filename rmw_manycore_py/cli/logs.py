# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore logs`."""

from __future__ import annotations

import json
import select
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import asdict

import click

from rmw_manycore_py.cli.common.completion import complete_nodes_of_runs
from rmw_manycore_py.cli.common.finite_range import WholeRange
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.runs import no_run, nodes_by_run
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.event_text import SUPERVISOR
from rmw_manycore_py.launch.events import Output
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory, runs_of
from rmw_manycore_py.launch.runs.log_file import RUN_LOG
from rmw_manycore_py.launch.runs.log_reader import LogLine, NodeLog, in_order


@click.command(
    "logs",
    epilog=examples(
        "manycore logs",
        "manycore logs -f talker listener",
        "manycore logs --tail 20 --timestamps talker",
    ),
)
@click.argument("nodes", nargs=-1, shell_complete=complete_nodes_of_runs)
@click.option("-f", "--follow", is_flag=True, help="Follow the output until Ctrl-C.")
@click.option(
    "-n",
    "--tail",
    type=WholeRange(min=0),
    metavar="N",
    help="Show only the last N lines of each node.",
)
@click.option("-t", "--timestamps", is_flag=True, help="Show the time of each line.")
@click.option("--no-prefix", is_flag=True, help="Leave out the names of the nodes.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per line.")
@platform_option
def command(
    nodes: tuple[str, ...],
    follow: bool,
    tail: int | None,
    timestamps: bool,
    no_prefix: bool,
    as_json: bool,
    platform: str,
) -> None:
    """Show the output of NODES, also after their end.

    By default that of all nodes and of the run itself. The last 8 MiB of each node are kept
    until the next run of the platform, less in runs with many nodes. With --follow, the command
    ends with the run.
    """
    runs = runs_of(platform)
    if not runs:
        raise ManycoreError(no_run(platform))
    chosen = nodes_by_run(runs, nodes) or [(run, [RUN_LOG, *run.nodes]) for run in runs]
    shown = {RUN_LOG: SUPERVISOR}
    logs = [NodeLog(run, name, shown.get(name, name)) for run, names in chosen for name in names]
    printer = _Printer([log.node for log in logs], timestamps, no_prefix, as_json)
    with ExitStack() as stack:
        # Subscribe before reading, so that no line falls in between.
        living = [run for run, _ in chosen if run.is_alive] if follow else []
        clients = [stack.enter_context(Client(run, "follow")) for run in living]
        printer.show(in_order(logs, tail))
        _follow(clients, logs, printer)
    for run in living:
        _report_end(run)


class _Printer:
    """Prints log lines."""

    def __init__(
        self, names: Sequence[str], timestamps: bool, no_prefix: bool, as_json: bool
    ) -> None:
        self._printer = RunPrinter(names)
        self._timestamps = timestamps
        self._no_prefix = no_prefix
        self._as_json = as_json

    def show(self, lines: Iterable[LogLine]) -> None:
        for line in lines:
            text = f"{line.time} {line.text}" if self._timestamps else line.text
            if self._as_json:
                click.echo(json.dumps(asdict(line)))
            elif self._no_prefix:
                click.echo(text)
            else:
                self._printer.report(Output(line.node, text))


def _follow(clients: list[Client], logs: Sequence[NodeLog], printer: _Printer) -> None:
    """Print new lines until the last supervisor has ended."""
    while clients:
        readable, _, _ = select.select([client.socket for client in clients], [], [])
        for client in tuple(clients):
            if client.socket in readable and client.take() is None:
                clients.remove(client)
        printer.show(in_order(logs))


def _report_end(run: RunDirectory) -> None:
    click.secho(f"the run of platform {run.platform} has ended", fg="yellow", err=True)
