# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options and arguments that several commands have."""

from __future__ import annotations

import click

from rmw_manycore_py.ros.domain import checked_platform, default_platform


def _checked(_context: click.Context, _option: click.Parameter, name: str | None) -> str | None:
    return None if name is None else checked_platform(name, "--platform")


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
platform_option = click.option(
    "--platform",
    default=default_platform,
    callback=_checked,
    show_default="$MANYCORE_PLATFORM, or domain-$ROS_DOMAIN_ID",
    help="Name of the platform.",
)
any_platform_option = click.option(
    "--platform", callback=_checked, help="Only the platform of this name."
)
values_argument = click.argument("values", default="{}")
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
hidden_option = click.option(
    "--include-hidden",
    "--include-hidden-topics",
    "--include-hidden-services",
    "hidden",
    is_flag=True,
    help="Show names with a part that starts with _ too.",
)


def examples(*lines: str) -> str:
    """Return the end of a help text, with a mark that keeps click from joining the lines."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)
