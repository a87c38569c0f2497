# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service type`, with the output format of `ros2 service type`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_services
from rmw_manycore_py.cli.common.names import show_types
from rmw_manycore_py.cli.common.options import discovery_options, examples, platform_option


@click.command("type", epilog=examples("manycore service type /switch_lamp"))
@click.argument("service", shell_complete=complete_services)
@discovery_options
@platform_option
def command(service: str, platform: str) -> None:
    """Print the type of SERVICE."""
    rows = view.services(view.endpoints_on(platform), hidden=True)
    show_types(rows, service, "service")
