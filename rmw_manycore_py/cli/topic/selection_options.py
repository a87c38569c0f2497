# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options that select the topics to record or play."""

from __future__ import annotations

import re
from collections.abc import Iterable

import click

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ros.names import expand


def _compiled(
    _context: click.Context, _option: click.Parameter, text: str | None
) -> re.Pattern[str] | None:
    try:
        return None if text is None else re.compile(text)
    except re.error as error:
        raise click.BadParameter(f"'{text}' is not a regular expression: {error}") from error


regex_option = click.option(
    "-e",
    "--regex",
    metavar="REGEX",
    callback=_compiled,
    help="Select topics whose name contains a match of REGEX.",
)
exclude_regex_option = click.option(
    "-x",
    "--exclude-regex",
    metavar="REGEX",
    callback=_compiled,
    help="Exclude topics whose name contains a match of REGEX.",
)
exclude_option = click.option(
    "--exclude-topics",
    "excluded",
    metavar="TOPIC",
    multiple=True,
    help="Exclude this topic or pattern; may be repeated.",
)


def full_names(names: Iterable[str]) -> tuple[str, ...]:
    """Return names and patterns with a leading slash."""
    return tuple(expand(name, "/") for name in names)


def nothing_chosen() -> ManycoreError:
    """Return the error for a missing selection of topics."""
    return ManycoreError(
        "no topics given: expected names, patterns such as '/camera/*', --all, --regex or "
        "--topic-types",
        EXIT_BAD_INPUT,
    )
