# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The option --timeout of verbs on parameters, whose node may still be starting."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.node_names import existing_node

DEFAULT_TIMEOUT_S = 1.0

timeout_option = click.option(
    "--timeout",
    "timeout_s",
    metavar="S",
    type=float,
    default=DEFAULT_TIMEOUT_S,
    show_default=True,
    help="Wait up to S seconds for the node; forever if negative.",
)


def waited_for(platform: str, node: str, timeout_s: float) -> str:
    """Return the full name of a node, waiting for it up to the timeout."""
    return existing_node(platform, node, timeout_s, "Node not found:")
