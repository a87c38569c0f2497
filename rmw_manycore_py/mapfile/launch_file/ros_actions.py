# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The actions of launch_ros, under their own names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.actions import (
    Action,
    Condition,
    environment,
    note_options,
)
from rmw_manycore_py.mapfile.launch_file.context import (
    LaunchContext,
    LaunchedNode,
    RefusedError,
    join_namespace,
)
from rmw_manycore_py.mapfile.launch_file.parameters import ParameterFile, evaluate_all
from rmw_manycore_py.mapfile.launch_file.substitutions import perform


class Node(Action):
    """`node`: a ROS 2 node."""

    def __init__(
        self,
        *,
        executable: Any,
        package: Any = None,
        name: Any = None,
        namespace: Any = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[Any, Any]] | None = None,
        arguments: Any = None,
        ros_arguments: Any = None,
        additional_env: Any = None,
        condition: Condition | None = None,
        **options: Any,
    ) -> None:
        super().__init__(condition=condition)
        self.executable, self.package = executable, package
        self.name, self.namespace = name, namespace
        self.parameters, self.remappings = parameters, list(remappings or ())
        self.arguments, self.ros_arguments = arguments, ros_arguments
        self.additional_env, self.options = dict(additional_env or {}), options

    @override
    def execute(self, context: LaunchContext) -> None:
        note_options(context, self.line, self.options)
        name = None if self.name is None else perform(context, self.name) or None
        executable = perform(context, self.executable)
        given = "" if self.namespace is None else perform(context, self.namespace)
        namespace = join_namespace(context.scope.namespace, given)
        full_name = f"{namespace.rstrip('/')}/{name or executable}"
        remappings = tuple((perform(context, a), perform(context, b)) for a, b in self.remappings)
        package = None if self.package is None else perform(context, self.package)
        context.nodes.append(
            LaunchedNode(
                file=context.file,
                line=self.line,
                name=name,
                namespace=namespace,
                package=package,
                executable=executable,
                command=() if package else (executable,),
                parameters=context.scope.parameters
                + evaluate_all(context, self.parameters, full_name),
                remappings=context.scope.remappings + remappings,
                arguments=tuple(perform(context, word) for word in self.arguments or ()),
                ros_arguments=tuple(perform(context, word) for word in self.ros_arguments or ()),
                env=environment(context, self.additional_env),
            )
        )


class LifecycleNode(Node):
    """A node with managed states; bringing it through them is left to whoever manages it."""


class ComposableNodeContainer(Action):
    """Components loaded into one process are not nodes that can be placed on cores."""

    def __init__(self, *, condition: Condition | None = None, **_described: Any) -> None:
        super().__init__(condition=condition)

    @override
    def execute(self, context: LaunchContext) -> None:
        raise RefusedError(
            "nodes with an executable of their own", "a container of composable nodes"
        )


class LoadComposableNodes(ComposableNodeContainer):
    """The same."""


class PushROSNamespace(Action):
    """`push-ros-namespace`: puts the nodes that follow below a namespace."""

    def __init__(self, namespace: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.namespace = namespace

    @override
    def execute(self, context: LaunchContext) -> None:
        pushed = perform(context, self.namespace)
        context.scope.namespace = join_namespace(context.scope.namespace, pushed)


class SetRemap(Action):
    """`set_remap`: for the nodes that follow."""

    def __init__(self, src: Any, dst: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.src, self.dst = src, dst

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.remappings += ((perform(context, self.src), perform(context, self.dst)),)


class SetParameter(Action):
    """`set_parameter`: for the nodes that follow."""

    def __init__(self, name: Any, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = name, value

    @override
    def execute(self, context: LaunchContext) -> None:
        name = perform(context, self.name)
        context.scope.parameters += evaluate_all(context, [{name: self.value}], "")


class SetParametersFromFile(Action):
    """`set_parameters_from_file`: for the nodes that follow."""

    def __init__(self, filename: Any, *, condition: Condition | None = None, **_named: Any) -> None:
        super().__init__(condition=condition)
        self.filename = filename

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.parameters += evaluate_all(context, [ParameterFile(self.filename)], "")
