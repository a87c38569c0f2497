# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore status`."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.options import any_platform_option, examples, json_option
from rmw_manycore_py.cli.common.printing import (
    echo,
    escaped,
    new_table,
    print_json,
    print_table,
    size_text,
)
from rmw_manycore_py.cli.common.rows import Row, cluster_row, platform_row, process_row
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.platform.transfers import transfer_text
from rmw_manycore_py.ros.names import node_names_by_process


@dataclass(frozen=True)
class PlatformState:
    """Data shown of one platform."""

    info: _transport.PlatformInfo
    clusters: list[_transport.ClusterInfo]
    processes: list[_transport.ProcessInfo]
    nodes: defaultdict[int, list[str]]  # full names by process slot
    losses: list[Row]
    superseded: list[Row]
    copies: list[Row]
    transfers: list[_transport.TopicConfiguration]

    @classmethod
    def of(cls, name: str) -> PlatformState:
        """Read the state of a platform."""
        with view.open_platform(name) as opened:
            endpoints = opened.endpoints()
            return cls(
                opened.info(),
                opened.clusters(),
                opened.processes(),
                node_names_by_process(opened.nodes()),
                view.losses(endpoints),
                view.superseded(endpoints),
                view.copies(endpoints),
                [topic for topic in opened.topic_table() if topic.transfer != "dsm"],
            )

    def row(self) -> Row:
        """Return the JSON row."""
        return {
            **platform_row(self.info),
            "clusters": [cluster_row(cluster) for cluster in self.clusters],
            "processes": [{**process_row(p), "nodes": self.nodes[p.slot]} for p in self.processes],
            "losses": self.losses,
            "superseded": self.superseded,
            "copies": self.copies,
            "transfers": [
                {
                    "topic": topic.name,
                    "transfer": topic.transfer,
                    "priority": topic.priority,
                    "synchronous": topic.synchronous,
                }
                for topic in self.transfers
            ],
        }


@dataclass(frozen=True)
class Unreadable:
    """A platform that cannot be read."""

    name: str
    error: str

    def row(self) -> Row:
        """Return the JSON row."""
        return {"name": self.name, "error": self.error}


@click.command("status", epilog=examples("manycore status", "manycore status --platform domain-0"))
@any_platform_option
@json_option
def command(platform: str | None, as_json: bool) -> None:
    """Show this user's platforms and lost messages.

    Clusters, processes, and messages lost per topic; copies of large messages.
    """
    if platform:
        states: list[PlatformState | Unreadable] = [PlatformState.of(platform)]
    else:
        states = [_look_at(name) for name in view.platform_names()]
    if as_json:
        print_json([state.row() for state in states])
        return
    if not states:
        echo("no platform is running")
    for number, state in enumerate(states):
        if number:
            echo()
        _show(state)


def _look_at(name: str) -> PlatformState | Unreadable:
    """Return the state of a platform, or its error so that the others are still shown."""
    try:
        return PlatformState.of(name)
    except (ManycoreError, _transport.PlatformError) as error:
        return Unreadable(name, str(error))


def _show(state: PlatformState | Unreadable) -> None:
    if isinstance(state, Unreadable):
        echo(f"platform {state.name}: {state.error}")
        return
    alive = "alive" if state.info.alive else "dead: `manycore clean` removes it"
    echo(f"platform {state.info.name}: {alive}")
    _show_clusters(state.clusters)
    _show_processes(state)
    for topic in state.transfers:
        text = transfer_text(topic.transfer, topic.priority, topic.synchronous)
        echo(f"{escaped(topic.name)}: transfer {text}")
    for row in state.copies:
        names, copied = escaped(f"{row['node']} {row['topic']}"), row["copies_per_message"]
        words = [] if copied is None else [f"copies per message {copied:.2g}"]
        words += [f"held {size_text(row['held_bytes'])}"] if row["held_bytes"] else []
        echo(f"{names}: {', '.join(words)}")
    for loss in state.losses:
        names = escaped(f"{loss['node']} {loss['topic']}")
        click.secho(f"{names}: {loss['counter']} {loss['count']}", fg="red")


def _show_clusters(clusters: list[_transport.ClusterInfo]) -> None:
    columns = ("#cluster", "receive thread", "#SMEM", "#used", "#messages")
    table = new_table(*columns, expendable=("messages", "receive thread"))
    for cluster in clusters:
        thread = f"pid {cluster.receive_thread_pid}" if cluster.alive else "not running"
        sizes = (size_text(cluster.smem_bytes), size_text(cluster.used_bytes))
        table.add_row(str(cluster.id), thread, *sizes, str(cluster.messages))
    print_table(table)


def _show_processes(state: PlatformState) -> None:
    columns = ("#pid", "#cluster", "#core", "#host CPU", "program", "nodes", "state")
    table = new_table(*columns, expendable=("program", "host CPU", "state", "pid"))
    for process in state.processes:
        numbers = (process.pid, process.cluster, process.core, process.host_cpu)
        texts = ("-" if number is None else str(number) for number in numbers)
        alive = "alive" if process.alive else "dead"
        table.add_row(*texts, process.label, ", ".join(state.nodes[process.slot]), alive)
    print_table(table)
