# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore action send_goal`, with the output format of `ros2 action send_goal`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.cli.common.completion import complete_actions, complete_types_of_action
from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.common.message_text import ALL, to_yaml
from rmw_manycore_py.cli.common.message_values import message_of, parse_values
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import result_of, tool_node
from rmw_manycore_py.cli.common.values_argument import DEFAULTS, values_argument
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.spinning import spin_once

# Index = value in action_msgs/msg/GoalStatus.
STATUSES = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")


@click.command(
    "send_goal",
    epilog=examples(
        "manycore action send_goal /fibonacci test_msgs/action/Fibonacci '{order: 5}'",
        "manycore action send_goal -f /fibonacci test_msgs/action/Fibonacci '{order: 5}'",
    ),
)
@click.argument("action", shell_complete=complete_actions)
@click.argument("type_name", metavar="TYPE", shell_complete=complete_types_of_action)
@values_argument("goal")
@click.option("-f", "--feedback", "shows_feedback", is_flag=True, help="Print feedback as well.")
@platform_option
def command(
    action: str, type_name: str, goal: str | None, shows_feedback: bool, platform: str
) -> None:
    """Send GOAL to ACTION and print the result.

    GOAL is YAML. Ctrl-C cancels the goal.
    """
    action_type = load_type(type_name, "action")
    request = message_of(action_type.Goal, parse_values(goal or DEFAULTS))
    with tool_node(platform) as node:
        from rclpy.action import ActionClient

        client = ActionClient(node, action_type, action)
        echo("Waiting for an action server to become available...")
        while not client.server_is_ready():
            spin_once(node)
        echo(f"Sending goal:\n     {_text(request)}")
        feedback = _show_feedback if shows_feedback else None
        handle = result_of(node, lambda: client.send_goal_async(request, feedback), action)
        if not handle.accepted:
            raise ManycoreError("Goal was rejected.")
        try:
            echo(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
            _show_result(result_of(node, handle.get_result_async, action))
        except KeyboardInterrupt:
            _cancel(node, handle, action)


def _text(message: Any) -> str:
    return to_yaml(message, ALL)


def _show_feedback(message: Any) -> None:
    echo(f"Feedback:\n    {_text(message.feedback)}")


def _show_result(answer: Any) -> None:
    echo(f"Result:\n    {_text(answer.result)}")
    echo(f"Goal finished with status: {STATUSES[answer.status]}")


def _cancel(node: Any, handle: Any, action: str) -> None:
    echo("Canceling goal...")
    if not result_of(node, handle.cancel_goal_async, action).goals_canceling:
        raise ManycoreError(f"{action}: the goal could not be canceled")
    echo("Goal canceled.")
