# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore interface proto`, with the output format of `ros2 interface proto`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.common.completion import complete_types
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.message_text import ALL, to_yaml
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

# The part of a type that a user writes: the message, the request, or the goal.
_PARTS = {"msg": None, "srv": "Request", "action": "Goal"}


@click.command("proto", epilog=examples("manycore interface proto std_srvs/srv/SetBool"))
@click.argument("type_name", metavar="TYPE", shell_complete=complete_types)
@click.option("--no-quotes", is_flag=True, help="Print the prototype without quotes.")
def command(type_name: str, no_quotes: bool) -> None:
    """Print a prototype of TYPE to edit.

    Of a service its request, of an action its goal.
    """
    text = to_yaml(_prototype(type_name), ALL)
    echo(text if no_quotes else f'"{text}"')


def _prototype(type_name: str) -> Any:
    parts = type_name.split("/")
    if len(parts) != 3 or parts[1] not in _PARTS:
        raise ManycoreError(
            f"Invalid name '{type_name}': expected package/msg/Name, package/srv/Name or "
            "package/action/Name",
            EXIT_BAD_INPUT,
        )
    loaded, part = load_type(type_name, parts[1]), _PARTS[parts[1]]
    return getattr(loaded, part)() if part else loaded()
