# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Actions of ROS 2 launch that change the environment and launch arguments."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import perform, text_or_missing
from rmw_manycore_py.mapfile.launch_file.typed_values import boolean


class AppendEnvironmentVariable(Action):
    """`append_env`: appends to a variable for later processes."""

    def __init__(
        self,
        name: Any,
        value: Any,
        prepend: Any = False,
        separator: Any = os.pathsep,
        *,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.name, self.value = name, value
        self.prepend, self.separator = prepend, separator

    @override
    def execute(self, context: LaunchContext) -> None:
        name, value = perform(context, self.name), perform(context, self.value)
        if name in context.environment:
            parts = [context.environment[name], value]
            ordered = reversed(parts) if boolean(context, self.prepend) else parts
            value = perform(context, self.separator).join(ordered)
        context.scope.environment[name] = value


class UnsetEnvironmentVariable(Action):
    """`unset_env`."""

    def __init__(self, name: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name

    @override
    def execute(self, context: LaunchContext) -> None:
        name = perform(context, self.name)
        context.scope.environment.pop(name, None)
        if name in os.environ:
            context.scope.unset |= {name}
            context.notice(self.line, f"{name} is unset for the launch file, not for its nodes")


class UnsetLaunchConfiguration(Action):
    """`unset`."""

    def __init__(self, name: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name

    @override
    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations.pop(perform(context, self.name), None)


class PushEnvironment(Action):
    """Pushes the environment on a stack."""

    @override
    def execute(self, context: LaunchContext) -> None:
        context.environments.append(dict(context.scope.environment))


class PopEnvironment(Action):
    """Restores the environment pushed last."""

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.environment = _popped(context.environments)


class ResetEnvironment(Action):
    """Restores the initial environment of the launch."""

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.environment.clear()


class PushLaunchConfigurations(Action):
    """Pushes the launch arguments on a stack."""

    @override
    def execute(self, context: LaunchContext) -> None:
        context.configurations.append(dict(context.launch_configurations))


class PopLaunchConfigurations(Action):
    """Restores the launch arguments pushed last."""

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.configurations = _popped(context.configurations)


class ResetLaunchConfigurations(Action):
    """`reset`: keeps only the given launch arguments."""

    def __init__(
        self,
        launch_configurations: Mapping[Any, Any] | None = None,
        *,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.launch_configurations = dict(launch_configurations or {})

    @override
    def execute(self, context: LaunchContext) -> None:
        kept = {
            perform(context, name): text_or_missing(context, value)
            for name, value in self.launch_configurations.items()
        }
        context.scope.configurations = kept


def _popped(stack: list[dict[str, str]]) -> dict[str, str]:
    if not stack:
        raise LaunchFileError("a push before each pop", "none")
    return stack.pop()
