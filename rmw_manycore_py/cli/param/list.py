# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param list`, with the output format of `ros2 param list`."""

from __future__ import annotations

import re

import click
from typing_extensions import override

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.node_names import existing_node, nodes_with_service
from rmw_manycore_py.cli.common.options import examples, graph_options, hidden_option
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.parameters import TYPES, Parameters
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ros.names import is_hidden

_PREFIXES = "--param-prefixes"


class _ManyPrefixes(click.Command):
    """Gives --param-prefixes all words up to the next option, as ros2cli does."""

    @override
    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        expanded: list[str] = []
        inside = False
        for word, following in zip(args, [*args[1:], "-"], strict=False):
            inside = word == _PREFIXES or (inside and not word.startswith("-"))
            if word == _PREFIXES:
                expanded += [word] if following.startswith("-") else []  # click reports it
            else:
                expanded += [_PREFIXES, word] if inside else [word]
        return super().parse_args(ctx, expanded)


@click.command(
    "list",
    cls=_ManyPrefixes,
    epilog=examples("manycore param list", "manycore param list /controller"),
)
@click.argument("node", required=False, shell_complete=complete_nodes)
@click.option(
    _PREFIXES,
    "prefixes",
    multiple=True,
    metavar="PREFIX",
    help="Only parameters below these prefixes, up to the next option.",
)
@click.option(
    "--filter", "expression", metavar="REGEX", help="Only names that match REGEX at their start."
)
@click.option("--param-type", "shows_types", is_flag=True, help="Show parameter types.")
@hidden_option
@graph_options
def command(
    node: str | None,
    prefixes: tuple[str, ...],
    expression: str | None,
    shows_types: bool,
    platform: str,
    as_json: bool,
    hidden: bool,
) -> None:
    """List the parameters of NODE, or of all nodes."""
    wanted = _pattern(expression or "")
    if node:
        names = [existing_node(platform, node, missing="Node not found:")]
    else:
        owners = nodes_with_service(
            platform, "list_parameters", "rcl_interfaces/srv/ListParameters"
        )
        names = [name for name in owners if hidden or not is_hidden(name)]
    with tool_node(platform) as tool:
        found = {name: _types(Parameters(tool, name), prefixes) for name in names}
    found = {
        name: {parameter: kind for parameter, kind in types.items() if wanted.match(parameter)}
        for name, types in found.items()
    }
    if as_json:
        print_json(found)
        return
    for name, types in found.items():
        if types and not node:
            echo(escaped(f"{name}:"))
        for parameter, type_name in types.items():
            of_type = f" (type: {type_name})" if shows_types else ""
            echo(escaped(f"  {parameter}{of_type}"))


def _pattern(expression: str) -> re.Pattern[str]:
    try:
        return re.compile(expression)
    except re.error as error:
        raise ManycoreError(f"--filter: {error}", EXIT_BAD_INPUT) from error


def _types(parameters: Parameters, prefixes: tuple[str, ...]) -> dict[str, str]:
    names = parameters.names(prefixes)
    return {d.name: TYPES[d.type][0] for d in parameters.descriptors(names)} if names else {}
