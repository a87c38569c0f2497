# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Client of the lifecycle services of a node."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.cli.common.completion import completer, platform_of
from rmw_manycore_py.cli.common.node_names import absolute_name, nodes_with_service
from rmw_manycore_py.cli.common.tool_node import answer_of
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean


def lifecycle_nodes(platform: str) -> list[str]:
    """Return the full names of the lifecycle nodes."""
    return nodes_with_service(platform, "get_state", "lifecycle_msgs/srv/GetState")


def existing_lifecycle_node(platform: str, name: str) -> str:
    """Return the full name of a lifecycle node; raise ManycoreError if it does not exist."""
    full_name, known = absolute_name(name), lifecycle_nodes(platform)
    if full_name not in known:
        meant = did_you_mean(full_name, known) or " (`manycore lifecycle nodes` shows all)"
        raise ManycoreError(f"Node not found: no '{full_name}' with a lifecycle{meant}")
    return full_name


complete_lifecycle_nodes = completer(lambda context: lifecycle_nodes(platform_of(context)))


class Lifecycle:
    """Client of the lifecycle of one node."""

    def __init__(self, node: Any, name: str) -> None:
        self._node, self._name = node, name

    def state(self) -> Any:
        """Return the current lifecycle_msgs State."""
        return self._call("GetState", "get_state").current_state

    def transitions(self, *, every: bool = False) -> list[Any]:
        """Return the TransitionDescriptions available now, or with `every` those of all states."""
        service = "get_transition_graph" if every else "get_available_transitions"
        return list(self._call("GetAvailableTransitions", service).available_transitions)

    def change(self, transition: Any) -> bool:
        """Request a lifecycle_msgs Transition; return whether it succeeded."""
        return bool(self._call("ChangeState", "change_state", transition=transition).success)

    def _call(self, type_name: str, service: str, **fields: Any) -> Any:
        import lifecycle_msgs.srv

        service_type = getattr(lifecycle_msgs.srv, type_name)
        client = self._node.create_client(service_type, f"{self._name}/{service}")
        return answer_of(self._node, client, service_type.Request(**fields))
