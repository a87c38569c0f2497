# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore lifecycle set`, with the output format of `ros2 lifecycle set`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.common.options import examples, named_node_options, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.lifecycle.services import (
    Lifecycle,
    complete_lifecycle_nodes,
    existing_lifecycle_node,
)
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError


@click.command("set", epilog=examples("manycore lifecycle set /camera configure"))
@click.argument("node", shell_complete=complete_lifecycle_nodes)
@click.argument("transition")
@named_node_options
@platform_option
def command(node: str, transition: str, platform: str) -> None:
    """Trigger TRANSITION, a label or id, on NODE."""
    name = existing_lifecycle_node(platform, node)
    with tool_node(platform) as tool:
        lifecycle = Lifecycle(tool, name)
        available = [found.transition for found in lifecycle.transitions()]
        if not lifecycle.change(_chosen(available, transition)):
            raise ManycoreError("Transitioning failed")
    echo("Transitioning successful")


def _chosen(available: list[Any], wanted: str) -> Any:
    for candidate in available:
        if wanted in (candidate.label, str(candidate.id)):
            return candidate
    choices = "".join(f"\n- {each.label} [{each.id}]" for each in available)
    raise ManycoreError(
        f"Unknown transition requested, available ones are:{choices}", EXIT_BAD_INPUT
    )
