# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Print JSON, notices, tables, sizes and counts."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

import click
from rich.console import Console
from rich.table import Table


def print_json(data: Any) -> None:
    """Print data as JSON."""
    click.echo(json.dumps(data, indent=2, default=str))


def print_notices(notices: Iterable[str]) -> None:
    """Print notices to standard error, apart from the output proper."""
    for notice in notices:
        click.secho(f"notice: {notice}", fg="yellow", err=True)


def new_table(*columns: str) -> Table:
    """Return a plain table; columns whose name starts with # are numeric."""
    table = Table(box=None, pad_edge=False)
    for column in columns:
        is_number = column.startswith("#")
        table.add_column(column.lstrip("#"), justify="right" if is_number else "left")
    return table


def print_table(table: Table) -> None:
    """Print a table; into a pipe, at its natural width for grep and cut."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=1000)
        for column in table.columns:
            column.no_wrap = True
    with console.capture() as capture:
        console.print(table)
    click.echo("\n".join(line.rstrip() for line in capture.get().splitlines()))


def size_text(size_bytes: int) -> str:
    """Format a number of bytes with a binary unit: 4 MiB."""
    for unit, shift in (("GiB", 30), ("MiB", 20), ("KiB", 10)):
        if size_bytes >= 1 << shift:
            return f"{size_bytes / (1 << shift):.4g} {unit}"
    return f"{size_bytes} B"


def counted(number: int, noun: str) -> str:
    """Format a count with its noun: 1 node, 2 nodes."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
