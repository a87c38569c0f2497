# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore status`."""

from __future__ import annotations

import click

from rmw_manycore_py import _transport
from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import new_table, print_json, print_table, size_text
from rmw_manycore_py.cli.common.view import Row
from rmw_manycore_py.errors import ManycoreError


@click.command("status", epilog=examples("manycore status", "manycore status --platform domain-0"))
@click.option("--platform", help="Only the platform of this name.")
@json_option
def command(platform: str | None, as_json: bool) -> None:
    """Show the platforms of this user: clusters, processes, and messages that were lost."""
    if platform:
        states = [view.platform_state(view.open_platform(platform))]
    else:
        states = [_look_at(name) for name in view.platform_names()]
    if as_json:
        print_json(states)
        return
    if not states:
        click.echo("no platform is running")
    for number, state in enumerate(states):
        if number:
            click.echo()
        _show(state)


def _look_at(name: str) -> Row:
    """Return the state of a platform, or what is wrong with it: one bad one hides no other."""
    try:
        return view.platform_state(view.open_platform(name))
    except (ManycoreError, _transport.PlatformError) as error:
        return {"name": name, "error": str(error)}


def _show(state: Row) -> None:
    if "error" in state:
        click.echo(f"platform {state['name']}: {state['error']}")
        return
    alive = "alive" if state["alive"] else "dead: `manycore clean` removes it"
    click.echo(f"platform {state['name']}: {alive}")
    _show_clusters(state["clusters"])
    _show_processes(state["processes"])
    for loss in state["losses"]:
        click.echo(f"{loss['node']} {loss['topic']}: {loss['counter']} {loss['count']}")


def _show_clusters(clusters: list[Row]) -> None:
    columns = ("#cluster", "receive thread", "#SMEM", "#used", "#messages")
    table = new_table(*columns)
    for row in clusters:
        thread = f"pid {row['receive_thread_pid']}" if row["alive"] else "not running"
        sizes = (size_text(row["smem_size"]), size_text(row["used"]))
        table.add_row(str(row["id"]), thread, *sizes, str(row["messages"]))
    print_table(table)


def _show_processes(processes: list[Row]) -> None:
    columns = ("#pid", "#cluster", "#core", "#host CPU", "program", "nodes", "state")
    table = new_table(*columns)
    for row in processes:
        numbers = (row["pid"], row["cluster"], row["core"], row["host_cpu"])
        texts = ("-" if number is None else str(number) for number in numbers)
        state = "alive" if row["alive"] else "dead"
        table.add_row(*texts, row["label"], ", ".join(row["nodes"]), state)
    print_table(table)
