# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore param describe`, with the output format of `ros2 param describe`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click

from rmw_manycore_py.cli.common.completion import complete_nodes
from rmw_manycore_py.cli.common.message_text import to_plain
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.param.awaited_node import awaited_node_options, waited_for
from rmw_manycore_py.cli.param.parameters import TYPES, Parameters


@click.command("describe", epilog=examples("manycore param describe /controller gain"))
@click.argument("node", shell_complete=complete_nodes)
@click.argument("parameters", nargs=-1, required=True)
@json_option
@awaited_node_options
def command(
    node: str, parameters: tuple[str, ...], timeout_s: float, platform: str, as_json: bool
) -> None:
    """Describe PARAMETERS of NODE.

    Type, description and constraints.
    """
    name = waited_for(platform, node, timeout_s)
    with tool_node(platform) as tool:
        descriptors = Parameters(tool, name).descriptors(parameters)
    if as_json:
        print_json([to_plain(descriptor) for descriptor in descriptors])
        return
    for descriptor in descriptors:
        echo("\n".join(_lines(descriptor)))


def _lines(descriptor: Any) -> Iterator[str]:
    yield f"Parameter name: {descriptor.name}"
    yield f"  Type: {TYPES[descriptor.type][0]}"
    if descriptor.description:
        yield f"  Description: {descriptor.description}"
    yield "  Constraints:"
    if descriptor.read_only:
        yield "    Read only: true"
    for allowed in (*descriptor.floating_point_range, *descriptor.integer_range):
        yield f"    Min value: {allowed.from_value}"
        yield f"    Max value: {allowed.to_value}"
        if allowed.step:
            yield f"    Step: {allowed.step}"
    if descriptor.additional_constraints:
        yield f"    Additional constraints: {descriptor.additional_constraints}"
