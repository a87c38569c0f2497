# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Print names with types: topics, services, actions."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.cli.common.printing import echo, escaped, print_json
from rmw_manycore_py.cli.common.rows import Row
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean


def show_names(
    rows: Sequence[Row], *, as_json: bool, types: bool = False, count: bool = False
) -> None:
    """Print one name per line, optionally with types; or only their number."""
    if as_json:
        print_json(rows)
    elif count:
        echo(len(rows))
    else:
        for row in rows:
            name = escaped(row["name"])
            echo(f"{name} [{escaped(', '.join(row['types']))}]" if types else name)


def row_of(rows: Sequence[Row], name: str, kind: str) -> Row:
    """Return the row of that name; raise ManycoreError if there is none."""
    for row in rows:
        if row["name"] == name:
            return row
    raise unknown(name, kind, rows)


def unknown(name: str, kind: str, rows: Sequence[Row]) -> ManycoreError:
    """Return the error for a name that is not among the rows."""
    meant = did_you_mean(name, (row["name"] for row in rows))
    return ManycoreError(
        f"Unknown {kind} '{name}'" + (meant or f" (manycore {kind} list shows all)")
    )


def show_types(rows: Sequence[Row], name: str, kind: str) -> None:
    """Print the types of the named entity, one per line."""
    for type_name in row_of(rows, name, kind)["types"]:
        echo(escaped(type_name))
