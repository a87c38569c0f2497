# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options and arguments that several commands have."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click
from click.shell_completion import CompletionItem

from rmw_manycore_py.ros.domain import checked_platform, default_platform

Command = TypeVar("Command", bound=Callable[..., Any])
_HIDDEN = f"{__name__}.hidden"


def _checked(_context: click.Context, _option: click.Parameter, name: str | None) -> str | None:
    return None if name is None else checked_platform(name, "--platform")


def _complete_platforms(
    context: click.Context, option: click.Parameter, incomplete: str
) -> list[CompletionItem[str]]:
    """Offer platforms; imports what finds them late, as the doctor has to do without it."""
    from rmw_manycore_py.cli.common.completion import complete_platforms

    return complete_platforms(context, option, incomplete)


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
platform_option = click.option(
    "--platform",
    default=default_platform,
    callback=_checked,
    shell_complete=_complete_platforms,
    show_default="$MANYCORE_PLATFORM, or domain-$ROS_DOMAIN_ID",
    help="Name of the platform.",
)
any_platform_option = click.option(
    "--platform",
    callback=_checked,
    shell_complete=_complete_platforms,
    help="Only the platform of this name.",
)
types_option = click.option("-t", "--show-types", is_flag=True, help="Show the types too.")
count_option = click.option(
    "-c",
    "--count",
    "--count-topics",
    "--count-services",
    "--count-nodes",
    "--count-actions",
    "count",
    is_flag=True,
    help="Show their number only.",
)


def _hidden(context: click.Context, _option: click.Parameter, value: bool) -> bool:
    return value or bool(context.meta.get(_HIDDEN))


def _all_hidden(context: click.Context, _option: click.Parameter, value: bool) -> None:
    context.meta[_HIDDEN] = value


hidden_option = click.option(
    "--include-hidden",
    "--include-hidden-topics",
    "--include-hidden-services",
    "--include-hidden-nodes",
    "hidden",
    is_flag=True,
    callback=_hidden,
    help="Show names with a part that starts with _ too.",
)


def hidden_group_option(name: str) -> Callable[[Command], Command]:
    """Return the option of a group that sets `hidden_option` of all its verbs."""
    return click.option(
        name,
        is_flag=True,
        expose_value=False,
        callback=_all_hidden,
        help="Show names with a part that starts with _ too, in every verb.",
    )


def discovery_options(command: Command) -> Command:
    """Add the options of ros2cli about discovery, for verbs that only look.

    The registry tells at once who is there, so none of them changes anything.
    """
    return _without_discovery(
        click.option(
            "-s",
            "--use-sim-time",
            is_flag=True,
            expose_value=False,
            help="Accepted as of ros2: this verb needs no time.",
        )(command)
    )


def named_node_options(command: Command) -> Command:
    """Add the options of ros2cli for verbs that take the name of a node."""
    return discovery_options(
        click.option(
            "--include-hidden-nodes",
            is_flag=True,
            expose_value=False,
            help="Accepted as of ros2: a node that is named may be hidden.",
        )(command)
    )


def talking_options(command: Command) -> Command:
    """Add those options for verbs whose node waits or measures; gives the argument `sim_time`."""
    return _without_discovery(
        click.option(
            "-s",
            "--use-sim-time",
            "sim_time",
            is_flag=True,
            help="Take the time from the topic /clock.",
        )(command)
    )


def _without_discovery(command: Command) -> Command:
    for option in (
        click.option(
            "--no-daemon",
            is_flag=True,
            expose_value=False,
            help="Accepted as of ros2: there is no daemon.",
        ),
        click.option(
            "--spin-time",
            type=float,
            metavar="S",
            expose_value=False,
            help="Accepted as of ros2: nothing has to be discovered.",
        ),
    ):
        command = option(command)
    return command


def examples(*lines: str) -> str:
    """Return the end of a help text, with a mark that keeps click from joining the lines."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)
