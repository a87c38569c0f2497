# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options and arguments shared by several commands."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click
from click.shell_completion import CompletionItem

from rmw_manycore_py.cli.common.finite_range import FiniteRange, WholeRange
from rmw_manycore_py.ros.domain import checked_platform, default_platform

Command = TypeVar("Command", bound=Callable[..., Any])
_HIDDEN = f"{__name__}.hidden"


def _checked(_context: click.Context, _option: click.Parameter, name: str | None) -> str | None:
    return None if name is None else checked_platform(name, "--platform")


def _complete_platforms(
    context: click.Context, option: click.Parameter, incomplete: str
) -> list[CompletionItem[str]]:
    """Offer platforms; imports the finder late, since `manycore doctor` must run without it."""
    from rmw_manycore_py.cli.common.completion import complete_platforms

    return complete_platforms(context, option, incomplete)


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
platform_option = click.option(
    "--platform",
    metavar="NAME",
    default=default_platform,
    callback=_checked,
    shell_complete=_complete_platforms,
    show_default="$MANYCORE_PLATFORM, or domain-$ROS_DOMAIN_ID",
    help="Name of the platform.",
)
any_platform_option = click.option(
    "--platform",
    metavar="NAME",
    callback=_checked,
    shell_complete=_complete_platforms,
    help="Only the platform of this name.",
)
rates_option = click.option(
    "--trace",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Show rates and loads of this trace, of `run --trace` or `trace save`.",
)
types_option = click.option("-t", "--show-types", is_flag=True, help="Also show the types.")
count_option = click.option(
    "-c",
    "--count",
    "--count-topics",
    "--count-services",
    "--count-nodes",
    "--count-actions",
    "count",
    is_flag=True,
    help="Print only their number.",
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
    help="Also show hidden names (a part starts with _).",
)


def hidden_group_option(name: str) -> Callable[[Command], Command]:
    """Return a group option that sets `hidden_option` for all verbs of the group."""
    return click.option(
        name,
        is_flag=True,
        expose_value=False,
        callback=_all_hidden,
        help="Also show hidden names (a part starts with _), in every verb.",
    )


def discovery_options(command: Command) -> Command:
    """Add the discovery options of ros2cli to a read-only verb.

    They have no effect: the registry lists the whole graph at once.
    """
    return _without_discovery(
        click.option(
            "-s",
            "--use-sim-time",
            is_flag=True,
            expose_value=False,
            help="Accepted for compatibility with ros2: discovery takes no time.",
        )(command)
    )


def named_node_options(command: Command) -> Command:
    """Add the options of ros2cli for verbs that take a node name."""
    return discovery_options(
        click.option(
            "--include-hidden-nodes",
            is_flag=True,
            expose_value=False,
            help="Accepted for compatibility with ros2: hidden nodes are found by name.",
        )(command)
    )


def graph_options(command: Command) -> Command:
    """Add the options of verbs that show the graph; passes `as_json` and `platform`."""
    return discovery_options(json_option(platform_option(command)))


def listing_options(command: Command) -> Command:
    """Add the options of verbs that list names; passes `count` and `hidden`, too."""
    return count_option(hidden_option(graph_options(command)))


def number_option(
    *names: str,
    within: tuple[float, float | None],
    default: float,
    metavar: str = "N",
    **more: Any,
) -> Callable[[Command], Command]:
    """Return an option for a number within bounds; its help shows the default."""
    number_range: Any = WholeRange if isinstance(default, int) else FiniteRange
    return click.option(
        *names,
        type=number_range(*within),
        default=default,
        metavar=metavar,
        show_default=True,
        **more,
    )


def talking_options(command: Command) -> Command:
    """Add those options to a verb that spins a node; passes the argument `sim_time`."""
    return _without_discovery(
        click.option(
            "-s",
            "--use-sim-time",
            "sim_time",
            is_flag=True,
            help="Use simulated time from the topic /clock.",
        )(command)
    )


def _without_discovery(command: Command) -> Command:
    for option in (
        click.option(
            "--no-daemon",
            is_flag=True,
            expose_value=False,
            help="Accepted for compatibility with ros2: there is no daemon.",
        ),
        click.option(
            "--spin-time",
            type=FiniteRange(),
            metavar="S",
            expose_value=False,
            help="Accepted for compatibility with ros2: there is no discovery.",
        ),
    ):
        command = option(command)
    return command


def examples(*lines: str) -> str:
    """Return an examples epilog, marked so that click does not rewrap its lines."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)
