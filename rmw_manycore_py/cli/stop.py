# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore stop`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import click

from rmw_manycore_py.cli.common.completion import complete_nodes_of_runs
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.cli.common.runs import end_of, living_runs, no_run, nodes_by_run
from rmw_manycore_py.errors import EXIT_FAILURE, ManycoreError
from rmw_manycore_py.launch.events import Finished, event_of
from rmw_manycore_py.launch.platform import remaining_users
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory, runs_of
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors


@click.command(
    "stop",
    epilog=examples("manycore stop", "manycore stop talker", "manycore stop --platform domain-3"),
)
@click.argument("nodes", nargs=-1, shell_complete=complete_nodes_of_runs)
@click.option("--now", is_flag=True, help="Do not wait for slow nodes.")
@platform_option
def command(nodes: tuple[str, ...], now: bool, platform: str) -> None:
    """Stop the runs of a platform, or only NODES.

    `manycore restart` starts single nodes again. Nodes get SIGINT, SIGTERM after 5 s, and
    SIGKILL after another 3 s; --now sends the next signal at once, like a second Ctrl-C. The
    exit status is that of the run. Stopping a platform without running processes is not an
    error.
    """
    if nodes:
        for run, names in nodes_by_run(living_runs(platform), nodes):
            _stop_nodes(run, names)
        return
    known = runs_of(platform)
    for run in known:
        if run.killed_after:
            echo(end_of(run))
            run.forget()
    runs = [run for run in known if run.is_alive]
    if not runs:
        _explain(platform)
        return
    # Runs that joined stop before the run that started the platform.
    sys.exit(max(_stop(run, now) for run in reversed(runs)))


def _stop(run: RunDirectory, now: bool) -> int:
    """Stop a run; return its exit status."""
    printer = RunPrinter(run.nodes)
    try:
        with Client(run, "stop") as client:
            if now:
                with Client(run, "stop"):
                    pass
            status = None
            for message in client.messages():
                if event := event_of(message):
                    printer.report(event)
                if isinstance(event, Finished):
                    status = event.exit_status
        run.wait()
        if status is not None:
            return status
    except ManycoreError:
        if run.is_alive:
            raise
        return 0  # the run was ending by itself
    raise ManycoreError(f"the supervisor of platform '{run.platform}' died before its run was over")


def _stop_nodes(run: RunDirectory, names: Sequence[str]) -> None:
    printer = RunPrinter(run.nodes)
    with Client(run, "stop", nodes=names) as client:
        waits_for = set(client.answer["waits_for"])
        for message in client.messages() if waits_for else ():
            if event := event_of(message):
                printer.report(event)
            if message.get("event") == "ended":
                waits_for.discard(message["node"])
            if not waits_for:
                return


def _explain(platform: str) -> None:
    """Report the state of a platform without a supervisor."""
    if users := remaining_users(platform):
        raise ManycoreError(
            f"{no_run(platform)}: it is used by {', '.join(users)}, started by other means; "
            "stop them where they were started",
            EXIT_FAILURE,
        )
    with translate_native_errors():
        removed = _transport.clean(platform) if platform in _transport.platforms() else []
    what = "its leftovers were removed" if removed else "nothing runs on it"
    echo(f"platform {platform} is stopped: {what}")
