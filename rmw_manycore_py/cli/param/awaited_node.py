# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The node whose parameters a verb is about; it may still be starting."""

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
    help="Wait S seconds for the node to come up; for ever if negative.",
)


def waited_for(platform: str, node: str, timeout_s: float) -> str:
    """Return the full name of a node that is there, or comes within a timeout."""
    return existing_node(platform, node, timeout_s, "Node not found:")
