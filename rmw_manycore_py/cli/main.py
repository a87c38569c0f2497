# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The command line as a whole."""

from __future__ import annotations

import click

from rmw_manycore_py import __version__
from rmw_manycore_py.cli.group import LazyGroup

VERBS = {
    "run": "rmw_manycore_py.cli.run",
    "create": "rmw_manycore_py.cli.create",
    "map": "rmw_manycore_py.cli.map",
    "status": "rmw_manycore_py.cli.status",
    "topic": "rmw_manycore_py.cli.topic",
    "node": "rmw_manycore_py.cli.node",
    "clean": "rmw_manycore_py.cli.clean",
    "doctor": "rmw_manycore_py.cli.doctor",
    "env": "rmw_manycore_py.cli.env",
    "bench": "rmw_manycore_py.bench.command",
}


@click.group(cls=LazyGroup, modules=VERBS, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="manycore")
def cli() -> None:
    """Run ROS 2 nodes on the cores of a clustered many-core platform, and look at them.

    \b
    Examples:
      manycore run mapfiles/talker_listener.yaml
      manycore status
      manycore topic echo /chatter
    """


def main() -> None:
    """Be the command `manycore`."""
    cli(prog_name="manycore")
