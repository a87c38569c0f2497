# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Message values from the command line or standard input."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import Any

import click

from rmw_manycore_py.launch.processes.environment import enter_middleware

DEFAULTS = "{}"


def values_argument(name: str = "values") -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return a decorator that adds a YAML argument and its alternative, the option --stdin.

    The command gets None if neither is given.
    """

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        @click.argument(name, required=False)
        @click.option("--stdin", is_flag=True, help=f"Read {name.upper()} from standard input.")
        @functools.wraps(function)
        def with_values(stdin: bool, **others: Any) -> None:
            if stdin:
                exclude(("--stdin", True), (name.upper(), others[name] is not None))
                enter_middleware()  # re-executes this program, so do it before reading stdin
                others[name] = sys.stdin.read()
            function(**others)

        return with_values

    return decorate


def exclude(*parameters: tuple[str, bool]) -> None:
    """Fail with a usage error if more than one of these parameters is given.

    :param parameters: pairs of name and whether it is given.
    """
    given = [name for name, is_given in parameters if is_given]
    if len(given) > 1:
        raise click.UsageError(f"{given[0]} and {given[1]} are mutually exclusive.")
