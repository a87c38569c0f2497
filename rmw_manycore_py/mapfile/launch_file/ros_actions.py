# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of the actions of launch_ros."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition
from rmw_manycore_py.mapfile.launch_file.context import (
    LaunchContext,
    LaunchFileError,
    join_namespace,
)
from rmw_manycore_py.mapfile.launch_file.events import change_state
from rmw_manycore_py.mapfile.launch_file.launched import ForAllNodes, LaunchedNode
from rmw_manycore_py.mapfile.launch_file.parameters import ParameterFile, evaluate_all
from rmw_manycore_py.mapfile.launch_file.process_actions import ProcessAction
from rmw_manycore_py.mapfile.launch_file.substitutions import is_true, perform


class Node(ProcessAction):
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
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self.executable, self.package = executable, package
        self.name, self.namespace = name, namespace
        self.parameters, self.remappings = parameters, list(remappings or ())
        self.arguments, self.ros_arguments = arguments, ros_arguments
        self.known_name = ""

    def full_name(self, context: LaunchContext) -> str:
        """Return the full name: that of the executed action, or as far as known at this point."""
        return self.known_name or self._names(context)[2]

    def _names(self, context: LaunchContext) -> tuple[str | None, str, str]:
        name = None if self.name is None else perform(context, self.name) or None
        given = "" if self.namespace is None else perform(context, self.namespace)
        namespace = join_namespace(context.scope.namespace, given)
        label = name or perform(context, self.executable)
        return name, namespace, f"{namespace.rstrip('/')}/{label}"

    @override
    def label(self, context: LaunchContext) -> tuple[str | None, str]:
        try:
            _, namespace, full_name = self._names(context)
        except LaunchFileError:
            return None, "/"
        return full_name.rpartition("/")[2], namespace

    @override
    def execute(self, context: LaunchContext) -> None:
        name, namespace, full_name = self._names(context)
        self.known_name = full_name
        options = self.evaluate_options(context)
        executable = perform(context, self.executable)
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
                parameters=context.scope.parameters + evaluate_all(context, self.parameters),
                remappings=context.scope.remappings + remappings,
                arguments=tuple(perform(context, word) for word in self.arguments or ()),
                ros_arguments=tuple(perform(context, word) for word in self.ros_arguments or ()),
                env=options.env,
                is_fully_named=name is not None and self._has_namespace(context),
                serial=context.serial(self),
                prefix=options.prefix,
                cwd=options.cwd,
                start=context.start,
                respawn=options.respawn,
            )
        )

    def _has_namespace(self, context: LaunchContext) -> bool:
        return self.namespace is not None or bool(context.scope.namespace)


class LifecycleNode(Node):
    """A node with a managed lifecycle."""

    def __init__(self, *, autostart: Any = False, **described: Any) -> None:
        super().__init__(**described)
        self.autostart = autostart

    @override
    def execute(self, context: LaunchContext) -> None:
        super().execute(context)
        if is_true(context, self.autostart):
            change_state(context, [context.serial(self)], 1)
            change_state(context, [context.serial(self)], 3)


class PushROSNamespace(Action):
    """`push-ros-namespace`: prefixes the namespace of later nodes."""

    def __init__(self, namespace: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.namespace = namespace

    @override
    def execute(self, context: LaunchContext) -> None:
        pushed = perform(context, self.namespace)
        context.scope.namespace = join_namespace(context.scope.namespace, pushed)


class SetRemap(Action):
    """`set_remap`: for later nodes."""

    def __init__(self, src: Any, dst: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.src, self.dst = src, dst

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.remappings += ((perform(context, self.src), perform(context, self.dst)),)


class SetParameter(Action):
    """`set_parameter`: for later nodes."""

    def __init__(self, name: Any, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = name, value

    @override
    def execute(self, context: LaunchContext) -> None:
        name = perform(context, self.name)
        (values,) = evaluate_all(context, [{name: self.value}])
        assert isinstance(values, dict)
        context.scope.parameters += (ForAllNodes(values),)


class SetParametersFromFile(Action):
    """`set_parameters_from_file`: for later nodes."""

    def __init__(self, filename: Any, *, condition: Condition | None = None, **_named: Any) -> None:
        super().__init__(condition=condition)
        self.filename = filename

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.parameters += evaluate_all(context, [ParameterFile(self.filename)])


class SetUseSimTime(SetParameter):
    """`set_use_sim_time`."""

    def __init__(self, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__("use_sim_time", value, condition=condition)


class SetROSLogDir(Action):
    """`set_ros_log_dir`: for later processes."""

    def __init__(self, new_log_dir: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.new_log_dir = new_log_dir

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.environment["ROS_LOG_DIR"] = perform(context, self.new_log_dir)
