# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options of verbs that print messages: style and truncation."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import click

from rmw_manycore_py.cli.common.message_text import SHOWN_LENGTH, Shown
from rmw_manycore_py.cli.common.options import number_option


def shown_options(function: Callable[..., None]) -> Callable[..., None]:
    """Add the arguments `shown` and `style` (None, "csv", "flow" or "json") to a command."""

    @click.option("--csv", "style", flag_value="csv", help="Print comma-separated values.")
    @click.option("--flow-style", "style", flag_value="flow", help="Print each array on one line.")
    @click.option(
        "--json", "style", flag_value="json", help="Print one untruncated JSON object per line."
    )
    @click.option("-f", "--full-length", is_flag=True, help="Do not truncate strings and arrays.")
    @number_option(
        "-l",
        "--truncate-length",
        within=(0, None),
        default=SHOWN_LENGTH,
        help="Length at which strings and arrays are truncated.",
    )
    @click.option(
        "--no-arr", "no_arrays", is_flag=True, help="Print only the type and length of arrays."
    )
    @click.option("--no-str", "no_strings", is_flag=True, help="Print only the lengths of strings.")
    @functools.wraps(function)
    def with_shown(
        full_length: bool, truncate_length: int, no_arrays: bool, no_strings: bool, **others: Any
    ) -> None:
        length = None if full_length else truncate_length
        function(shown=Shown(length, not no_arrays, not no_strings), **others)

    return with_shown
