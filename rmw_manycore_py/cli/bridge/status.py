# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bridge status`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_bridge.counters import DROPS
from rmw_manycore_bridge.status import status
from rmw_manycore_py.cli.common.options import examples, json_option, platform_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table, size_text
from rmw_manycore_py.cli.common.view import open_platform
from rmw_manycore_py.platform.topology import host_cpu_text
from rmw_manycore_py.routes.outside import OutsideSettings

_ARROWS = {"inward": "<-", "outward": "->"}


@click.command("status", epilog=examples("manycore bridge status --json | jq '.[].messages'"))
@platform_option
@json_option
def command(platform: str, as_json: bool) -> None:
    """Show bridged topics and services.

    Traffic, and what was held back and why.
    """
    with open_platform(platform):
        rows = status(platform)
    if as_json:
        print_json(rows)
    elif not rows:
        echo(f"platform {platform} has no bridge")
    else:
        _show(rows)


def _show(rows: list[dict[str, Any]]) -> None:
    columns = ("inside", "", "outside", "#domain", "#lane", "#CPU", "#load", "state", "#messages")
    table = new_table(*columns, "#size", "#mean", "#max", "kept back")
    for row in rows:
        state = row["state"] if row["alive"] else "process is gone"
        drops = ", ".join(f"{row[name]} {name}" for name in DROPS if row[name])
        table.add_row(
            *(row["inside"], _ARROWS[row["direction"]], row["outside"], _domain(row)),
            *(str(row["lane"]), host_cpu_text(row["host_cpu"]), f"{row['load']:.1%}", state),
            *(str(row["messages"]), size_text(row["bytes"])),
            *(_time_text(row["latency_mean_ns"]), _time_text(row["latency_max_ns"])),
            drops or row["reason"],
        )
    print_table(table)
    echo(_datagrams_text(rows))


def _domain(row: dict[str, Any]) -> str:
    """Return the domain, or the other host, with the engine unless it is the default."""
    is_default = row["engine"] == OutsideSettings().engine
    return f"{row['domain']}" if is_default else f"{row['engine']} {row['peer'] or row['domain']}"


def _datagrams_text(rows: list[dict[str, Any]]) -> str:
    """Describe the cost of full receive buffers; count each process and each host once."""
    own = {row["pid"]: row["socket_drops"] for row in rows if row["socket_drops"] is not None}
    errors = max((row["receive_buffer_errors"] or 0 for row in rows), default=0)
    return (
        f"UDP datagrams dropped at full receive buffers: {sum(own.values())} of the bridge, "
        f"{errors} of all programs on this host"
    )


def _time_text(ns: int | None) -> str:
    return f"{ns / 1e6:.3f} ms" if ns else "-"
