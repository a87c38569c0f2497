# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ps`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import any_platform_option, examples, json_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.cli.common.rows import Row
from rmw_manycore_py.cli.common.runs import end_of, start_again
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory, all_runs, runs_of


@click.command("ps", epilog=examples("manycore ps", "manycore ps --json"))
@any_platform_option
@json_option
def command(platform: str | None, as_json: bool) -> None:
    """Show the nodes of this user's runs.

    Nodes that have ended are shown as well, and runs that were killed until they are started
    again or stopped. `manycore status` also shows nodes started by hand, by platform.
    """
    runs = runs_of(platform) if platform else all_runs()
    shown = [(run, _row(run)) for run in runs if run.is_alive or run.killed_after]
    if as_json:
        print_json([row for _, row in shown])
        return
    if not shown:
        echo("no run of `manycore run` or `manycore up`")
    for number, (run, row) in enumerate(shown):
        if number:
            echo()
        if row["killed_after"] is None:
            _show(row)
        else:
            stop = f"`manycore stop --platform {run.platform}` forgets it"
            echo(f"platform {run.platform}: {end_of(run)}; {start_again(run)}, {stop}")


def _row(run: RunDirectory) -> Row:
    info = run.info
    row = {
        "platform": run.platform,
        "run": run.number,
        "mapfile": info.get("mapfile"),
        "pid": info.get("pid"),
        "detached": info.get("detached"),
        "started": info.get("started"),
        "logs": run.logs,
        "killed_after": None,
    }
    if killed := run.killed_after:
        row["killed_after"] = killed.isoformat(timespec="seconds")
        return {**row, "nodes": []}
    try:
        with Client(run, "state") as client:
            return {**row, "nodes": client.answer["nodes"]}
    except ManycoreError as error:
        return {**row, "error": str(error), "nodes": []}


def _show(row: Row) -> None:
    kind = "in the background" if row["detached"] else "in a terminal"
    echo(f"platform {row['platform']}: {row['mapfile']}, {kind}, pid {row['pid']}")
    if "error" in row:
        echo(f"  {row['error']}")
        return
    columns = ("node", "#pid", "#cluster", "#core", "#respawns", "state")
    table = new_table(*columns, expendable=("pid", "respawns"))
    for node in row["nodes"]:
        numbers = (node["pid"], node["cluster"], node["core"], node["respawns"])
        texts = ("-" if number is None else str(number) for number in numbers)
        table.add_row(node["name"], *texts, _state(node))
    print_table(table)


def _state(node: Row) -> str:
    if node["reason"] is None or node["reason"] == node["state"]:
        return str(node["state"])
    return f"{node['state']}: {node['reason']}"
