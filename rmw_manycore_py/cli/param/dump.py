# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param dump`, with the output format of `ros2 param dump`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json, print_notices
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import TYPES, Parameters, nested
from rmw_manycore_py.mapfile.placing.parameter_values import parameters_yaml

# Types that parameter files have no values of, as in TYPES.
_NOT_IN_FILES = ("not set", "byte array")


@click.command("dump", epilog=examples("manycore param dump /controller > controller.yaml"))
@click.argument("node", shell_complete=complete_nodes)
@json_option
@awaited_node_options
def command(node: str, timeout_s: float, platform: str, as_json: bool) -> None:
    """Print all parameters of NODE as a parameter file.

    Byte arrays and parameters without a value are left out: such files cannot hold them.
    """
    name = waited_for(platform, node, timeout_s)
    with tool_node(platform) as tool:
        parameters = Parameters(tool, name)
        names = parameters.names()
        found = dict(zip(names, parameters.values(names), strict=True))
    if as_json:
        print_json(_file(name, found))
        return
    left_out = {n: TYPES[kind][0] for n, (kind, _) in found.items()}
    left_out = {n: kind for n, kind in left_out.items() if kind in _NOT_IN_FILES}
    print_notices(
        f"left out '{n}' ({kind}): parameter files cannot hold it" for n, kind in left_out.items()
    )
    kept = {n: typed for n, typed in found.items() if n not in left_out}
    echo(parameters_yaml(_file(name, kept)))


def _file(node: str, found: Mapping[str, tuple[int, Any]]) -> dict[str, Any]:
    values = ((name, value) for name, (_, value) in found.items())
    return {node: {"ros__parameters": nested(values)}}
