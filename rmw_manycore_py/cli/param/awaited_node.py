# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options of verbs on parameters, whose node may still be starting."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.cli.common.node_names import existing_node
from rmw_manycore_py.cli.common.options import Command, named_node_options, platform_option

DEFAULT_TIMEOUT_S = 1.0

_timeout_option = click.option(
    "--timeout",
    "timeout_s",
    metavar="S",
    type=FiniteRange(),
    default=DEFAULT_TIMEOUT_S,
    show_default=True,
    help="Wait up to S seconds for the node; forever if negative.",
)


def awaited_node_options(command: Command) -> Command:
    """Add the options of verbs on a node's parameters; passes `timeout_s` and `platform`."""
    return named_node_options(_timeout_option(platform_option(command)))


def waited_for(platform: str, node: str, timeout_s: float) -> str:
    """Return the full name of a node, waiting for it up to the timeout."""
    return existing_node(platform, node, timeout_s, "Node not found:")
