# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service call`, with the output format of `ros2 service call`."""

from __future__ import annotations

import time

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_services, complete_types_of_service
from rmw_manycore_py.cli.common.finite_range import MIN_RATE, FiniteRange
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.message_text import to_plain
from rmw_manycore_py.cli.common.message_values import message_of, parse_values
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo, json_text, print_notices
from rmw_manycore_py.cli.common.tool_node import result_of, tool_node
from rmw_manycore_py.cli.common.values_argument import DEFAULTS, values_argument
from rmw_manycore_py.errors.suggestions import closest
from rmw_manycore_py.process.spinning import spin_once


@click.command(
    "call",
    epilog=examples(
        "manycore service call /switch_lamp std_srvs/srv/SetBool '{data: true}'",
        "echo '{data: true}' | manycore service call --stdin /switch_lamp std_srvs/srv/SetBool",
        "manycore service call -r 2 /switch_lamp std_srvs/srv/SetBool",
    ),
)
@click.argument("service", shell_complete=complete_services)
@click.argument("type_name", metavar="TYPE", shell_complete=complete_types_of_service)
@values_argument()
@click.option(
    "-r",
    "--rate",
    "rate_hz",
    type=FiniteRange(min=MIN_RATE),
    help="Repeat the call at this rate in Hz.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object per response.")
@platform_option
def command(
    service: str,
    type_name: str,
    values: str | None,
    rate_hz: float | None,
    platform: str,
    as_json: bool,
) -> None:
    """Call SERVICE with VALUES in YAML.

    Waits for a server if there is none.
    """
    service_type = load_type(type_name, "srv")
    request = message_of(service_type.Request, parse_values(values or DEFAULTS))
    with tool_node(platform, until_ctrl_c=rate_hz is not None) as node:
        client = node.create_client(service_type, service)
        if not client.service_is_ready() and not as_json:
            echo("waiting for service to become available...")
            _suggest(service, platform)
        while not client.service_is_ready():
            spin_once(node)
        while True:
            if not as_json:
                echo(f"requester: making request: {request!r}\n")
            start_s = time.monotonic()
            response = result_of(node, lambda: client.call_async(request), service)
            echo(json_text(to_plain(response)) if as_json else f"response:\n{response!r}\n")
            if rate_hz is None:
                return
            time.sleep(max(0.0, start_s + 1 / rate_hz - time.monotonic()))


def _suggest(service: str, platform: str) -> None:
    """Suggest a similar service name."""
    rows = view.services(view.endpoints_on(platform), hidden=True)
    served = [row["name"] for row in rows if row["servers"]]
    if meant := closest(service, served):
        print_notices([f"there is no service '{service}' yet; did you mean '{meant}'?"])
