# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Values of a message on the command line, or on the standard input."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import Any

import click

from rmw_manycore_py.launch.processes.environment import enter_middleware

DEFAULTS = "{}"


def values_argument(name: str = "values") -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return what gives a command an argument in YAML, and the option --stdin in its place.

    The command gets None where there is neither.
    """

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        @click.argument(name, required=False)
        @click.option("--stdin", is_flag=True, help=f"Read {name.upper()} from standard input.")
        @functools.wraps(function)
        def with_values(stdin: bool, **others: Any) -> None:
            if stdin:
                exclude(("--stdin", True), (name.upper(), others[name] is not None))
                enter_middleware()  # restarts this program, which can read its input only once
                others[name] = sys.stdin.read()
            function(**others)

        return with_values

    return decorate


def exclude(*parameters: tuple[str, bool]) -> None:
    """Refuse a command line that has more than one of these parameters.

    :param parameters: the name of each, and whether it is given.
    """
    given = [name for name, is_given in parameters if is_given]
    if len(given) > 1:
        raise click.UsageError(f"{given[0]} and {given[1]} exclude each other.")
