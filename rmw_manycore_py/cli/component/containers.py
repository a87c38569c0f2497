# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Component containers, controlled through the services of composition_interfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rmw_manycore_py.cli.common.completion import completer, platform_of
from rmw_manycore_py.cli.common.node_names import absolute_name, nodes_with_service
from rmw_manycore_py.cli.common.tool_node import answer_of
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean

SERVICES = {"load_node": "LoadNode", "unload_node": "UnloadNode", "list_nodes": "ListNodes"}


@dataclass(frozen=True)
class Wanted:
    """A component to load; remap rules are "from:=to", parameters "name:=value" with YAML."""

    package: str
    plugin: str
    node_name: str = ""
    node_namespace: str = ""
    log_level: int = 0
    remap_rules: Sequence[str] = ()
    parameters: Sequence[str] = ()
    extra_arguments: Sequence[str] = ()


def containers_on(platform: str) -> list[str]:
    """Return the full names of the nodes that offer all three container services."""
    serving = [
        set(
            nodes_with_service(platform, f"_container/{name}", f"composition_interfaces/srv/{kind}")
        )
        for name, kind in SERVICES.items()
    ]
    return sorted(set.intersection(*serving))


def existing_container(platform: str, name: str) -> str:
    """Return the full name of a container; raise ManycoreError if it does not exist."""
    full_name, known = absolute_name(name), containers_on(platform)
    if full_name not in known:
        meant = did_you_mean(full_name, known) or " (`manycore component list` shows all)"
        raise ManycoreError(f"Unable to find container node '{full_name}'{meant}")
    return full_name


complete_containers = completer(lambda context: containers_on(platform_of(context)))


class Container:
    """Client of a component container."""

    def __init__(self, node: Any, name: str) -> None:
        self._node, self.name = node, name

    def components(self) -> list[tuple[int, str]]:
        """Return the id and the full node name of each component."""
        answer = self._call("list_nodes")
        return list(zip(answer.unique_ids, answer.full_node_names, strict=True))

    def load(self, wanted: Wanted) -> tuple[int, str]:
        """Load a component; return its id and full node name.

        :raises ManycoreError: if the container refuses.
        """
        answer = self._call(
            "load_node",
            package_name=wanted.package,
            plugin_name=wanted.plugin,
            node_name=wanted.node_name,
            node_namespace=wanted.node_namespace,
            log_level=wanted.log_level,
            remap_rules=list(wanted.remap_rules),
            parameters=_parameters(wanted.parameters, "-p"),
            extra_arguments=_parameters(wanted.extra_arguments, "-e"),
        )
        if not answer.success:
            raise ManycoreError(f"Failed to load component: {answer.error_message.capitalize()}")
        return answer.unique_id, answer.full_node_name

    def unload(self, unique_id: int) -> None:
        """Unload the component of that id.

        :raises ManycoreError: if the container refuses.
        """
        answer = self._call("unload_node", unique_id=unique_id)
        if not answer.success:
            raise ManycoreError(
                f"Failed to unload component {unique_id} from '{self.name}' container node\n"
                f"    {answer.error_message.capitalize()}"
            )

    def _call(self, name: str, **fields: Any) -> Any:
        from composition_interfaces import srv

        service_type = getattr(srv, SERVICES[name])
        client = self._node.create_client(service_type, f"{self.name}/_container/{name}")
        return answer_of(self._node, client, service_type.Request(**fields))


def loaded_line(unique_id: int, container: str, node: str) -> str:
    """Return the line that `ros2 component load` prints for a loaded component."""
    return f"Loaded component {unique_id} into '{container}' container node as '{node}'"


def _parameters(values: Sequence[str], option: str) -> list[Any]:
    """Return values "name:=value" as rcl_interfaces Parameters."""
    from rcl_interfaces.msg import Parameter
    from rclpy.parameter import get_parameter_value

    parameters = []
    for text in values:
        name, separator, value = text.partition(":=")
        if not (name and separator):
            raise ManycoreError(f"{option}: expected name:=value, found '{text}'", EXIT_BAD_INPUT)
        parameters.append(Parameter(name=name, value=get_parameter_value(value)))
    return parameters
