# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bridge CONFIG`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from rmw_manycore_bridge.config import load_plan
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.launch.bridge import run_bridge
from rmw_manycore_py.ros.domain import MAX_DOMAIN, ros_domain


@click.command("run", epilog=examples("manycore bridge run domain_bridge.yaml --platform robot"))
@click.argument("config", type=click.Path(dir_okay=False, exists=True, path_type=Path))
@click.option(
    "--inside",
    type=click.IntRange(0, MAX_DOMAIN),
    default=ros_domain,
    show_default="$ROS_DOMAIN_ID, or 0",
    help="Domain ID in CONFIG that stands for the platform.",
)
@platform_option
def command(config: Path, inside: int, platform: str) -> None:
    """Run the bridge described by CONFIG.

    In the YAML schema of domain_bridge. One side of each entry has to be the platform's domain;
    the other side is a DDS domain, or one of rmw_zenoh.
    """
    plan = load_plan(config, platform, inside, _warn)
    sys.exit(run_bridge(plan, RunPrinter().report))


def _warn(text: str) -> None:
    echo(text, err=True)
