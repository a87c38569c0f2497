# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore restart`."""

from __future__ import annotations

import sys
import time

import click

from rmw_manycore_py.cli.common.completion import complete_nodes_of_runs
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.runs import living_runs, nodes_by_run
from rmw_manycore_py.errors import EXIT_FAILURE
from rmw_manycore_py.launch.events import Ended, Finished, Restarting, Started, event_of
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory

# A program with a failing import exits after about 0.2 s.
LOOK_S = 1.0


@click.command("restart", epilog=examples("manycore restart talker", "manycore restart"))
@click.argument("nodes", nargs=-1, shell_complete=complete_nodes_of_runs)
@platform_option
def command(nodes: tuple[str, ...], platform: str) -> None:
    """Restart NODES, by default all.

    Nodes that have ended are started again. Nodes restart with the settings of their run: to
    apply a changed mapfile, use `manycore stop` and `up`. Watches the nodes for one second; the
    exit status is 1 if one ends again in that time.
    """
    runs = living_runs(platform)
    every = [(run, [n for n in run.nodes if not n.startswith("(")]) for run in runs]
    restarts = [_Restart(run, names) for run, names in (nodes_by_run(runs, nodes) or every)]
    sys.exit(max(restart.run() for restart in restarts))


class _Restart:
    """Restart in progress of some nodes of a run."""

    def __init__(self, run: RunDirectory, names: list[str]) -> None:
        self._run = run
        self._names = names
        self._waits_for = set(names)
        self._failed = False
        self._printer = RunPrinter(run.nodes)

    def run(self) -> int:
        """Restart the nodes; return the exit status."""
        with Client(self._run, "restart", nodes=self._names) as client:
            for message in client.messages():
                self._take(message)
                if not self._waits_for:
                    break
            self._look_on(client)
        return EXIT_FAILURE if self._failed or self._waits_for else 0

    def _look_on(self, client: Client) -> None:
        """Watch for nodes that end again at once."""
        deadline = time.monotonic() + LOOK_S
        while not self._failed and (left_s := deadline - time.monotonic()) > 0:
            messages = client.take(left_s)
            if messages is None:
                return
            for message in messages:
                self._take(message)

    def _take(self, message: dict[str, object]) -> None:
        event = event_of(message)
        if event is None or getattr(event, "node", self._names[0]) not in self._names:
            return
        self._printer.report(event)
        if isinstance(event, Started):
            self._waits_for.discard(event.node)
        elif isinstance(event, Finished):
            self._failed = True
        elif isinstance(event, Ended | Restarting) and event.node not in self._waits_for:
            self._failed = True
            for line in event.last_lines:
                echo(f"    {line}", err=True)
        elif isinstance(event, Ended):
            self._waits_for.discard(event.node)  # the start failed
            self._failed = True
