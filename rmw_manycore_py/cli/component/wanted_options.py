# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arguments and options that describe the component to load."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import click

from rmw_manycore_py.cli.common.completion import completer
from rmw_manycore_py.cli.component.containers import Wanted
from rmw_manycore_py.cli.component.registered import component_types, packages_with_components

# Values of rcl_interfaces/msg/Log; ros2cli accepts only the numbers.
LOG_LEVELS = {"unset": 0, "debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}

complete_component_packages = completer(lambda _context: packages_with_components())
_complete_plugins = completer(lambda context: component_types(context.params.get("package") or ""))


def wanted_options(function: Callable[..., None]) -> Callable[..., None]:
    """Add the argument `wanted`, a Wanted, to a command."""

    @click.argument("package", shell_complete=complete_component_packages)
    @click.argument("plugin", shell_complete=_complete_plugins)
    @click.option("-n", "--node-name", default="", help="Name of the component's node.")
    @click.option("--node-namespace", default="", help="Namespace of the component's node.")
    @click.option(
        "--log-level", default="unset", callback=_log_level, help="Log level, a name or a number."
    )
    @click.option(
        "-r",
        "--remap-rule",
        "remap_rules",
        multiple=True,
        metavar="FROM:=TO",
        help="Remap a name of the component; may be repeated.",
    )
    @click.option(
        "-p",
        "--parameter",
        "parameters",
        multiple=True,
        metavar="NAME:=VALUE",
        help="Parameter of the component; may be repeated.",
    )
    @click.option(
        "-e",
        "--extra-argument",
        "extra_arguments",
        multiple=True,
        metavar="NAME:=VALUE",
        help="Argument for the container; may be repeated.",
    )
    @functools.wraps(function)
    def with_wanted(**options: Any) -> None:
        asked = {name: options.pop(name) for name in Wanted.__dataclass_fields__}
        function(wanted=Wanted(**asked), **options)

    return with_wanted


def _log_level(_context: click.Context, _option: click.Parameter, text: str) -> int:
    if text.lower() in LOG_LEVELS:
        return LOG_LEVELS[text.lower()]
    if text.isdecimal() and int(text) < 256:
        return int(text)
    raise click.BadParameter(f"expected one of {', '.join(LOG_LEVELS)} or a number, found '{text}'")
