# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Print JSON, notices and tables; sizes and counts in words."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from typing import Any

import click
from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.table import Table
from rich.text import Text

from rmw_manycore_py.platform.texts import counted, size_text

__all__ = [
    "PlainTable",
    "counted",
    "echo",
    "escaped",
    "json_text",
    "new_table",
    "print_json",
    "print_notices",
    "print_table",
    "printable",
    "size_text",
]

_ANY_WIDTH = 1000  # of what is not for a terminal

# C0 and C1 control characters, line separators, and those that reorder the text around them; not
# the direction marks (U+200E, U+200F, U+061C), which Arabic and Hebrew texts contain.
_CONTROL = re.compile("[\0-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")


def escaped(text: str) -> str:
    """Return a text without control characters, line breaks included: a name within a line."""
    return _CONTROL.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def printable(text: str) -> str:
    """Return a text whose lines and tabs stay, without other control characters."""
    return "\n".join("\t".join(map(escaped, line.split("\t"))) for line in text.split("\n"))


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text that may hold names of other processes; their control characters do nothing."""
    click.echo(printable(str(text)), err=err, nl=nl)


def json_text(data: Any, indent: int | None = None) -> str:
    """Format data as JSON, which has no infinity, NaN or bytes: texts and numbers instead."""
    try:
        return json.dumps(data, indent=indent, default=_in_json, allow_nan=False)
    except ValueError:
        return json.dumps(_finite(data), indent=indent, default=_in_json, allow_nan=False)


def print_json(data: Any) -> None:
    """Print data as JSON."""
    click.echo(json_text(data, indent=2))


def _in_json(value: object) -> object:
    """Return a byte of ROS as a number, several bytes as a list."""
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    return str(value)


def _finite(data: Any) -> Any:
    """Replace infinity and NaN by texts."""
    if isinstance(data, dict):
        return {name: _finite(part) for name, part in data.items()}
    if isinstance(data, (list, tuple)):
        return [_finite(part) for part in data]
    return str(data) if isinstance(data, float) and not math.isfinite(data) else data


def print_notices(notices: Iterable[str]) -> None:
    """Print notices to standard error, apart from the output proper."""
    for notice in notices:
        click.secho(f"notice: {printable(notice)}", fg="yellow", err=True)


class PlainTable(Table):
    """Table without lines, whose texts are neither markup nor contain control characters.

    Where it is too wide, the columns `expendable` go first, in this order.
    """

    def __init__(self, expendable: Sequence[str]) -> None:
        super().__init__(box=None, pad_edge=False)
        self._expendable = expendable

    def add_row(self, *cells: RenderableType | None, **options: Any) -> None:
        """Add a row; a `Text` keeps its style."""
        super().add_row(*map(_plain_cell, cells), **options)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Render the columns for which there is room."""
        fitted = copy(self)
        for header in self._expendable:
            natural = console.measure(fitted, options=options.update_width(_ANY_WIDTH))
            if natural.maximum <= options.max_width:
                break
            kept = (one for one in fitted.columns if one.header != header)
            fitted.columns = [replace(one, _index=index) for index, one in enumerate(kept)]
        yield from Table.__rich_console__(fitted, console, options)


def _plain_cell(cell: RenderableType | None) -> RenderableType | None:
    if isinstance(cell, Text):
        return Text(escaped(cell.plain), cell.style, spans=cell.spans)
    return Text(escaped(cell)) if isinstance(cell, str) else cell


def new_table(*columns: str, expendable: Sequence[str] = ()) -> Table:
    """Return a plain table; columns whose name starts with # are numeric.

    :param expendable: columns that give way to names in a narrow terminal, the first one first.
    """
    table = PlainTable(expendable)
    for column in columns:
        is_number = column.startswith("#")
        table.add_column(column.lstrip("#"), justify="right" if is_number else "left")
    return table


def print_table(table: Table) -> None:
    """Print a table; into a pipe, at its natural width for grep and cut."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=_ANY_WIDTH)
        for column in table.columns:
            column.no_wrap = True
    with console.capture() as capture:
        console.print(table)
    click.echo("\n".join(line.rstrip() for line in capture.get().splitlines()))
