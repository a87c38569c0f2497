# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of the actions of launch_ros."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext, join_namespace
from rmw_manycore_py.mapfile.launch_file.events import change_state
from rmw_manycore_py.mapfile.launch_file.launched import LaunchedNode
from rmw_manycore_py.mapfile.launch_file.parameters import flat, parameters_of
from rmw_manycore_py.mapfile.launch_file.process_actions import ProcessAction, known_text
from rmw_manycore_py.mapfile.launch_file.substitution import perform


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
        self.parameters, self.remappings = parameters, remappings
        self.arguments, self.ros_arguments = arguments, ros_arguments
        self.known_name = ""

    def full_name(self, context: LaunchContext) -> str:
        """Return the full name: that of the executed action, or as far as known at this point."""
        return self.known_name or self._names(context)[2]

    def _names(self, context: LaunchContext) -> tuple[str | None, str, str]:
        name = None if self.name is None else perform(context, self.name) or None
        given = "" if self.namespace is None else perform(context, self.namespace)
        namespace = join_namespace(context.settings.namespace, given)
        label = name or perform(context, self.executable)
        return name, namespace, f"{namespace.rstrip('/')}/{label}"

    @override
    def known(self, context: LaunchContext) -> LaunchedNode:
        name, namespace, package, executable = (
            None if value is None else known_text(context, value)
            for value in (self.name, self.namespace, self.package, self.executable)
        )
        return LaunchedNode(
            file=context.file,
            line=self.line,
            name=name or None,
            namespace=join_namespace(context.settings.namespace, namespace or ""),
            package=package,
            executable=executable,
            serial=context.serial(self),
            start=context.start,
        )

    @override
    def execute(self, context: LaunchContext) -> None:
        name, namespace, full_name = self._names(context)
        self.known_name = full_name
        options = self.evaluate_options(context)
        executable = perform(context, self.executable)
        has_namespace = self.namespace is not None or bool(context.settings.namespace)
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
                parameters=parameters_of(context, self.parameters),
                remappings=remappings_of(context, self.remappings),
                arguments=tuple(perform(context, word) for word in self.arguments or ()),
                ros_arguments=tuple(perform(context, word) for word in self.ros_arguments or ()),
                env=options.env,
                is_fully_named=name is not None and has_namespace,
                serial=context.serial(self),
                prefix=options.prefix,
                cwd=options.cwd,
                start=context.start,
                respawn=options.respawn,
            )
        )


def remappings_of(context: LaunchContext, own: Any) -> tuple[tuple[str, str], ...]:
    """Return the remappings of a node, those of `set_remap` first."""
    evaluated = ((perform(context, old), perform(context, new)) for old, new in own or ())
    return (*context.settings.remappings, *evaluated)


class LifecycleNode(Node):
    """A node with a managed lifecycle."""

    def __init__(self, *, autostart: Any = False, **described: Any) -> None:
        super().__init__(**described)
        self.autostart = autostart

    @override
    def execute(self, context: LaunchContext) -> None:
        super().execute(context)
        if self.autostart:  # launch takes any object as it is
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
        context.settings.namespace = join_namespace(context.settings.namespace, pushed)


class SetRemap(Action):
    """`set_remap`: for later nodes."""

    def __init__(self, src: Any, dst: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.src, self.dst = src, dst

    @override
    def execute(self, context: LaunchContext) -> None:
        context.settings.add_remapping(perform(context, self.src), perform(context, self.dst))


class SetParameter(Action):
    """`set_parameter`: for later nodes."""

    def __init__(self, name: Any, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = name, value

    @override
    def execute(self, context: LaunchContext) -> None:
        for parameter in flat(context, {perform(context, self.name): self.value}).items():
            context.settings.add_parameters(parameter)


class SetParametersFromFile(Action):
    """`set_parameters_from_file`: for later nodes."""

    def __init__(self, filename: Any, *, condition: Condition | None = None, **_named: Any) -> None:
        super().__init__(condition=condition)
        self.filename = filename

    @override
    def execute(self, context: LaunchContext) -> None:
        context.settings.add_parameters(perform(context, self.filename))


class SetUseSimTime(Action):
    """`set_use_sim_time`: for timers of launch itself."""

    def __init__(self, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.value = value

    @override
    def execute(self, context: LaunchContext) -> None:
        context.notice(
            self.line, "set_use_sim_time has no effect here; set_parameter sets it for nodes"
        )


class SetROSLogDir(Action):
    """`set_ros_log_dir`: for later processes."""

    def __init__(self, new_log_dir: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.new_log_dir = new_log_dir

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.environment["ROS_LOG_DIR"] = perform(context, self.new_log_dir)
