# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Loads components into a container, or drives a lifecycle node through transitions, then exits.

Runs as a separate process on the node's platform, with a JSON request:
{"container": NAME, "components": [...]} or {"node": NAME, "transitions": [...]}.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from typing import Any

import rclpy
from lifecycle_msgs.srv import ChangeState
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter

_NODE = "_manycore_bring_up"  # names with a leading underscore are hidden
_TIMEOUT_S = 1.0


class NotDoneError(Exception):
    """The node rejected what the launch file requests."""


def bring_up(node: Node, request: Mapping[str, Any]) -> None:
    """Execute a request step by step."""
    if "container" in request:
        for component in request["components"]:
            _load(node, request["container"], component)
    else:
        for transition in request["transitions"]:
            _change_state(node, request["node"], transition)


def _load(node: Node, container: str, component: Mapping[str, Any]) -> None:
    from composition_interfaces.srv import LoadNode

    wanted = LoadNode.Request(
        package_name=component["package"],
        plugin_name=component["plugin"],
        node_name=component["name"],
        node_namespace=component["namespace"],
        remap_rules=[f"{source}:={target}" for source, target in component["remappings"]],
        parameters=_parameters(component["parameters"]),
        extra_arguments=_parameters(component["extra_arguments"]),
    )
    answer = _call(node, LoadNode, f"{container}/_container/load_node", wanted)
    if not answer.success:
        name = component["name"] or component["plugin"]
        raise NotDoneError(f"{name} was not loaded into {container}: {answer.error_message}")
    print(f"loaded {answer.full_node_name} into {container}", flush=True)


def _change_state(node: Node, name: str, transition: int) -> None:
    wanted = ChangeState.Request()
    wanted.transition.id = transition
    answer = _call(node, ChangeState, f"{name}/change_state", wanted)
    if not answer.success:
        raise NotDoneError(f"{name} did not make transition {transition}")
    print(f"{name} made transition {transition}", flush=True)


def _call(node: Node, kind: Any, service: str, wanted: Any) -> Any:
    client = node.create_client(kind, service)
    try:
        while not client.wait_for_service(timeout_sec=_TIMEOUT_S):
            if not rclpy.ok():
                raise ExternalShutdownException
        future = client.call_async(wanted)
        rclpy.spin_until_future_complete(node, future)
        if not future.done():
            raise ExternalShutdownException
        return future.result()
    finally:
        node.destroy_client(client)


def _parameters(values: Mapping[str, Any]) -> list[Any]:
    return [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]


def main() -> int:
    """Execute the request in the first argument; return the exit status."""
    rclpy.init()
    node = Node(_NODE, enable_rosout=False, start_parameter_services=False)
    try:
        bring_up(node, json.loads(sys.argv[1]))
    except NotDoneError as error:
        print(error, file=sys.stderr, flush=True)
        return 1
    except ExternalShutdownException:
        return 0
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
