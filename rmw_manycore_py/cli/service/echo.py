# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service echo`, with the output format of `ros2 service echo`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_services, complete_types_of_service
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.message_text import Shown, plain_to_yaml, to_csv, to_plain
from rmw_manycore_py.cli.common.names import row_of
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo, json_text, print_notices
from rmw_manycore_py.cli.common.shown_options import shown_options
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.process.spinning import spin_once
from rmw_manycore_py.ros.names import expand

# Index = value in service_msgs/msg/ServiceEventInfo.
EVENTS = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")


@click.command(
    "echo",
    epilog=examples(
        "manycore service echo /switch_lamp",
        "manycore service echo --csv /switch_lamp std_srvs/srv/SetBool",
    ),
)
@click.argument("service", shell_complete=complete_services)
@click.argument(
    "type_name", metavar="[TYPE]", required=False, shell_complete=complete_types_of_service
)
@shown_options
@platform_option
def command(
    service: str, type_name: str | None, shown: Shown, style: str | None, platform: str
) -> None:
    """Print requests and responses of SERVICE.

    Its nodes have to enable service introspection. Servers and clients enable it with
    configure_introspection().
    """
    service = expand(service, "/")
    service_type = load_type(type_name or _type_of(service, platform), "srv")
    topic = f"{service}/_service_event"

    def heard(event: Any) -> None:
        echo(_text(event, style, shown))

    with tool_node(platform, until_ctrl_c=True) as node:
        from rclpy.qos import QoSPresetProfiles

        qos = QoSPresetProfiles.get_from_short_key("services_default")
        subscription = node.create_subscription(service_type.Event, topic, heard, qos)
        if not subscription.get_publisher_count():
            print_notices(
                [
                    f"No publishers on topic '{topic}'; "
                    "is service introspection on the client or server enabled?"
                ]
            )
        while True:
            spin_once(node)


def _type_of(service: str, platform: str) -> str:
    rows = view.services(view.endpoints_on(platform), hidden=True)
    type_name: str = row_of(rows, service, "service")["types"][0]
    return type_name


def _text(event: Any, style: str | None, shown: Shown) -> str:
    """Format an event; its kind is a name except in CSV, as in ros2cli."""
    if style == "csv":
        return to_csv(event, shown)
    plain = to_plain(event) if style == "json" else to_plain(event, shown)
    plain["info"]["event_type"] = EVENTS[plain["info"]["event_type"]]
    if style == "json":
        return json_text(plain)
    return f"{plain_to_yaml(plain, flow_style=style == 'flow')}---"
