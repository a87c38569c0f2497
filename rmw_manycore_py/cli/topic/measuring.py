# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arguments and output shared by `topic hz`, `bw` and `delay`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, TypeVar

import click

from rmw_manycore_py.cli.common.completion import complete_topics, complete_types_of_topic
from rmw_manycore_py.cli.common.options import number_option, platform_option, talking_options
from rmw_manycore_py.cli.common.printing import echo, json_text

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

PERIOD_S = 1.0

Command = TypeVar("Command", bound=Callable[..., Any])


def measuring_options(least: int, default: int, of: str) -> Callable[[Command], Command]:
    """Add TOPIC, TYPE, the window size and the output options."""

    def decorate(command: Command) -> Command:
        for decorator in (
            platform_option,
            talking_options,
            click.option(
                "--json", "as_json", is_flag=True, help="Print one JSON object per result."
            ),
            number_option(
                "-w",
                "--window",
                within=(least, None),
                default=default,
                help=f"Window size, in {of}.",
            ),
            click.argument(
                "type_name",
                metavar="[TYPE]",
                required=False,
                shell_complete=complete_types_of_topic,
            ),
            click.argument("topic", shell_complete=complete_topics),
        ):
            command = decorator(command)
        return command

    return decorate


def print_result(result: DataclassInstance, as_json: bool) -> None:
    """Print one result as text or JSON."""
    echo(json_text(asdict(result)) if as_json else result)
