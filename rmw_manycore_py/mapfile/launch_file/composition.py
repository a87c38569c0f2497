# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Component containers and the components loaded into them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext, join_namespace
from rmw_manycore_py.mapfile.launch_file.frame import calling_line
from rmw_manycore_py.mapfile.launch_file.launched import LaunchedComponent
from rmw_manycore_py.mapfile.launch_file.parameters import evaluate_all, parameters_of
from rmw_manycore_py.mapfile.launch_file.ros_actions import Node, remappings_of
from rmw_manycore_py.mapfile.launch_file.substitution import perform


class ComposableNode:
    """`composable_node`: description of a component."""

    def __init__(
        self,
        *,
        package: Any,
        plugin: Any,
        name: Any = None,
        namespace: Any = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[Any, Any]] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.package, self.plugin, self.name = package, plugin, name
        self.namespace, self.parameters = namespace, parameters
        self.remappings, self.extra_arguments = remappings, extra_arguments
        self.condition_of_node, self.line = condition, calling_line()

    def condition(self) -> Condition | None:
        """Return the condition for loading the component."""
        return self.condition_of_node

    def evaluate(self, context: LaunchContext) -> LaunchedComponent:
        """Return the component with the settings at this point of the launch file."""
        name = None if self.name is None else perform(context, self.name) or None
        given = "" if self.namespace is None else perform(context, self.namespace)
        namespace = join_namespace(context.settings.namespace, given)
        return LaunchedComponent(
            file=context.file,
            line=self.line,
            package=perform(context, self.package),
            plugin=perform(context, self.plugin),
            name=name,
            namespace=namespace,
            parameters=parameters_of(context, self.parameters),
            remappings=remappings_of(context, self.remappings),
            extra_arguments=evaluate_all(context, self.extra_arguments),
        )


def load(context: LaunchContext, container: str, descriptions: Iterable[Any]) -> None:
    """Record the loading of components into a container."""
    for one in descriptions:
        condition = one.condition()
        if condition is None or condition.evaluate(context):
            context.loads.append((container, one.evaluate(context)))


class ComposableNodeContainer(Node):
    """`node_container`: a process that loads components."""

    def __init__(
        self,
        *,
        name: Any,
        namespace: Any,
        composable_node_descriptions: Iterable[Any] | None = None,
        **described: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **described)
        self.descriptions = list(composable_node_descriptions or ())

    @override
    def execute(self, context: LaunchContext) -> None:
        super().execute(context)
        load(context, self.full_name(context), self.descriptions)


class LoadComposableNodes(Action):
    """`load_composable_node`: loads components into a named container."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[Any],
        target_container: Any,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.descriptions = list(composable_node_descriptions)
        self.target_container = target_container

    @override
    def execute(self, context: LaunchContext) -> None:
        target = self.target_container
        if isinstance(target, Node):
            name = target.full_name(context)
        else:
            name = join_namespace("", perform(context, target))
        load(context, name, self.descriptions)
