# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The options that say which topics are recorded or played."""

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
        raise click.BadParameter(f"'{text}' is no regular expression: {error}") from error


regex_option = click.option(
    "-e",
    "--regex",
    metavar="REGEX",
    callback=_compiled,
    help="Topics whose names this is found in.",
)
exclude_regex_option = click.option(
    "-x",
    "--exclude-regex",
    metavar="REGEX",
    callback=_compiled,
    help="None whose names this is found in.",
)
exclude_option = click.option(
    "--exclude-topics",
    "excluded",
    metavar="TOPIC",
    multiple=True,
    help="Not this topic or pattern; may be repeated.",
)


def full_names(names: Iterable[str]) -> tuple[str, ...]:
    """Return names and patterns with their leading slash."""
    return tuple(expand(name, "/") for name in names)


def nothing_chosen() -> ManycoreError:
    """Return the error that no topics were asked for."""
    return ManycoreError(
        "which topics? Name some, or patterns such as '/camera/*', or --all, --regex or "
        "--topic-types",
        EXIT_BAD_INPUT,
    )
