# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component list`, with the output format of `ros2 component list`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, graph_options
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.component.containers import (
    Container,
    complete_containers,
    containers_on,
    existing_container,
)


@click.command(
    "list", epilog=examples("manycore component list", "manycore component list /container")
)
@click.argument("container", required=False, shell_complete=complete_containers)
@click.option("--containers-only", is_flag=True, help="List only the containers.")
@graph_options
def command(container: str | None, containers_only: bool, as_json: bool, platform: str) -> None:
    """List containers and their components.

    Or only the components of CONTAINER.
    """
    names = [existing_container(platform, container)] if container else containers_on(platform)
    found: dict[str, list[tuple[int, str]]] = {name: [] for name in names}
    if names and not containers_only:
        with tool_node(platform) as tool:
            found = {name: Container(tool, name).components() for name in names}
    if as_json:
        print_json(
            {
                name: [{"id": unique_id, "node": node} for unique_id, node in components]
                for name, components in found.items()
            }
        )
        return
    for name, components in found.items():
        if not container:
            echo(escaped(name))
        for unique_id, node in components:
            echo(escaped(("" if container else "  ") + f"{unique_id}  {node}"))
