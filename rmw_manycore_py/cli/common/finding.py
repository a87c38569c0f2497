# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The verb `find` of topics and services."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.names import show_names
from rmw_manycore_py.cli.common.options import examples, listing_options
from rmw_manycore_py.cli.common.rows import Row


def find_command(
    kind: str, example: str, complete_types: Callable[..., Any], rows_of: Callable[..., list[Row]]
) -> click.Command:
    """Return the command that lists the topics or services of a type."""

    @click.command(
        "find",
        epilog=examples(f"manycore {kind} find {example}"),
        help=f"List the {kind}s of TYPE.",
    )
    @click.argument("type_name", metavar="TYPE", shell_complete=complete_types)
    @listing_options
    def command(type_name: str, platform: str, as_json: bool, hidden: bool, count: bool) -> None:
        rows = rows_of(view.endpoints_on(platform), hidden=hidden)
        rows = [row for row in rows if type_name in row["types"]]
        show_names(rows, as_json=as_json, count=count)

    return command
