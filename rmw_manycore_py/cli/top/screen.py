# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Screen layout of `manycore top`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from rmw_manycore_py.cli.common.printing import counted, new_table, size_text
from rmw_manycore_py.cli.common.rows import Row
from rmw_manycore_py.cli.top.rows import (
    NODE_ORDERS,
    TOPIC_ORDERS,
    cluster_rows,
    node_rows,
    ordered,
    topic_rows,
)
from rmw_manycore_py.picture.texts import time_text
from rmw_manycore_py.platform.monitor.watch import Look

BAR_WIDTH = 20
_HOT, _WARM = 80.0, 40.0  # percent
KEYS = "n t order of nodes, topics   r reverse   / filter   q quit"


@dataclass(frozen=True)
class Choices:
    """Settings changed by keys."""

    node_order: str = "cpu"
    topic_order: str = "bytes"
    reverse: bool = False
    pattern: str = ""
    is_typing: bool = False


def screen(look: Look, choices: Choices, height: int | None = None) -> RenderableType:
    """Render a look, limited to `height` lines of the terminal if given."""
    nodes = ordered(
        _matching(node_rows(look), "node", choices),
        NODE_ORDERS[choices.node_order],
        reverse=choices.reverse,
    )
    topics = ordered(
        _matching(topic_rows(look), "topic", choices),
        TOPIC_ORDERS[choices.topic_order],
        reverse=choices.reverse,
    )
    clusters = cluster_rows(look)
    room = None if height is None else max(height - len(clusters) - 7, 2)
    shown_nodes, shown_topics = _share(len(nodes), len(topics), room)
    virtual = "" if look.virtual_s is None else f"virtual time {look.virtual_s:.3f} s"
    parts: list[RenderableType] = [
        *([Text(virtual)] if virtual else []),
        _clusters(clusters),
        Text(),
        _nodes(nodes[:shown_nodes]),
        _rest(len(nodes) - shown_nodes, "node"),
        _topics(topics[:shown_topics]),
        _rest(len(topics) - shown_topics, "topic"),
    ]
    return Group(*parts, *([] if height is None else [_status(choices)]))


def _matching(rows: Sequence[Row], column: str, choices: Choices) -> list[Row]:
    return [row for row in rows if choices.pattern in row[column]]


def _share(nodes: int, topics: int, room: int | None) -> tuple[int, int]:
    """Return how many rows of each are shown: each gets half of the room, or what is left over."""
    if room is None or nodes + topics <= room:
        return nodes, topics
    half = room // 2
    if nodes <= half:
        return nodes, room - nodes
    return (room - topics, topics) if topics <= half else (half, room - half)


def _rest(count: int, noun: str) -> Text:
    return Text(f"and {counted(count, noun)} more" if count > 0 else "", style="dim")


def _clusters(rows: Sequence[Row]) -> Table:
    columns = ("#cluster", "SMEM", "#used", "#of", "#receive thread", "#CPU", "#messages/s")
    table = new_table(*columns, expendable=("SMEM", "receive thread"))
    for row in rows:
        percent = 100 * row["used"] / row["smem_size"] if row["smem_size"] else 0.0
        pid = row["receive_thread_pid"]
        table.add_row(
            str(row["cluster"]),
            bar(percent),
            size_text(row["used"]),
            size_text(row["smem_size"]),
            Text("not running", style="red") if pid is None else f"pid {pid}",
            _coloured(row["cpu_percent"], f"{row['cpu_percent']:.1f}%"),
            f"{row['messages_per_s']:.1f}",
        )
    return table


def _nodes(rows: Sequence[Row]) -> Table:
    columns = ("#pid", "#cluster", "#core", "#host CPU", "#CPU", "", "node")
    table = new_table(*columns, expendable=("", "host CPU", "pid", "core", "cluster"))
    table.columns[-1].no_wrap = True
    for row in rows:
        places = (row["pid"], row["cluster"], row["core"], row["host_cpu"])
        texts = ("-" if place is None else str(place) for place in places)
        shared = f"  (one of {row['shared']} in its process)" if row["shared"] > 1 else ""
        name = Text(f"{row['node']}{shared}")
        if row["state"] == "died":
            name = Text(f"{row['node']} died", style="bold red")
        percent = row["cpu_percent"]
        table.add_row(*texts, _coloured(percent, f"{percent:.1f}%"), bar(percent, 10), name)
    return table


def _topics(rows: Sequence[Row]) -> Table:
    table = new_table(
        *("#messages/s", "#bytes/s", "#p99", "#queue", "", "#lost", "#superseded"),
        *("#copies", "#held", "topic"),
        expendable=("", "copies", "held", "superseded", "p99", "queue", "bytes/s"),
    )
    table.columns[-1].no_wrap = True
    for row in rows:
        p99 = "-" if row["p99_us"] is None else time_text(row["p99_us"])
        queue = f"{row['queued']}/{row['capacity']}" if row["capacity"] else "-"
        table.add_row(
            f"{row['messages_per_s']:.1f}",
            size_text(round(row["bytes_per_s"])),
            p99,
            queue,
            bar(row["queue_percent"], 10),
            Text(str(row["lost"]), style="bold red" if row["lost"] else ""),
            str(row["superseded"] or "-"),
            "-" if row["copies"] is None else f"{row['copies']:.2g}",
            size_text(row["held"]) if row["held"] else "-",
            row["topic"],
        )
    return table


def bar(percent: float, width: int = BAR_WIDTH) -> Text:
    """Return a bar coloured by how full it is."""
    filled = min(max(round(percent / 100 * width), 1 if percent >= 1 else 0), width)
    text = Text("█" * filled, style=_colour(percent))
    return text.append("·" * (width - filled), style="dim")


def _coloured(percent: float, text: str) -> Text:
    return Text(text, style=_colour(percent))


def _colour(percent: float) -> str:
    if percent >= _HOT:
        return "red"
    return "yellow" if percent >= _WARM else "green"


def _status(choices: Choices) -> Text:
    if choices.is_typing:
        return Text(f"filter: {choices.pattern}_   (Enter: keep, Escape: none)", style="reverse")
    direction = ", reversed" if choices.reverse else ""
    text = f"nodes by {choices.node_order}, topics by {choices.topic_order}{direction}"
    if choices.pattern:
        text += f", with '{choices.pattern}'"
    return Text(f"{text}   {KEYS}", style="reverse")
