# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of the actions of ROS 2 launch; executing one records its effect."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

from typing_extensions import override

from rmw_manycore_py.errors import ManycoreError, Problem
from rmw_manycore_py.mapfile.launch_file import unavailable
from rmw_manycore_py.mapfile.launch_file.context import Later, LaunchContext
from rmw_manycore_py.mapfile.launch_file.frame import calling_line
from rmw_manycore_py.mapfile.launch_file.guard import failure, guarded
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.substitution import (
    Substitution,
    condition_holds,
    perform,
    text_or_missing,
)
from rmw_manycore_py.mapfile.launch_file.typed_values import FLOAT, coerce


class Condition:
    """Condition of an action; launch files also make their own, and call `_predicate_func`."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def describe(self) -> str:
        """Return a description, for launch files that print it."""
        return type(self).__name__

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the condition holds; without a predicate it does not."""
        return self._predicate is not None and self._predicate(context)


class IfCondition(Condition):
    """`if="..."`."""

    def __init__(self, predicate_expression: Any) -> None:
        super().__init__(predicate=self._predicate_func)
        self.predicate_expression = predicate_expression

    def _predicate_func(self, context: LaunchContext) -> bool:
        return condition_holds(context, self.predicate_expression)


class UnlessCondition(IfCondition):
    """`unless="..."`."""

    @override
    def _predicate_func(self, context: LaunchContext) -> bool:
        return not super()._predicate_func(context)


class LaunchConfigurationEquals(Condition):
    """Compares a launch argument with a text; an unset argument equals None."""

    def __init__(self, launch_configuration_name: str, expected_value: Any) -> None:
        super().__init__(predicate=self._predicate_func)
        self.name, self.expected_value = launch_configuration_name, expected_value

    def _predicate_func(self, context: LaunchContext) -> bool:
        found = context.launch_configurations.get(self.name)
        expected = self.expected_value
        return found == (None if expected is None else perform(context, expected))


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Negation of LaunchConfigurationEquals."""

    @override
    def _predicate_func(self, context: LaunchContext) -> bool:
        return not super()._predicate_func(context)


class Action:
    """One action of a launch file, with its line."""

    starts_process = False

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.condition = condition
        self.line = calling_line()

    def visit(self, context: LaunchContext) -> None:
        """Execute the action if its condition holds."""
        try:
            if self.condition is None or self.condition.evaluate(context):
                visit_all(context, self.execute(context) or ())
        except UnavailableError as error:
            self.cannot_run(context, error.at(context.file, self.line))
        except (ManycoreError, KeyboardInterrupt):
            raise
        except BaseException as error:  # launch does not expect such values either
            raise failure(context.file, error, self.line) from error

    def execute(self, context: LaunchContext) -> Any:
        """Record the action; custom actions of launch files may return other actions."""
        raise NotImplementedError

    def cannot_run(self, context: LaunchContext, problem: Problem) -> None:
        """Record that something is missing here."""
        with context.reading(problem.file):
            text = f"cannot run here: expected {problem.expected}, found {problem.found}"
            context.notice(problem.line, text)


class LaunchDescription(Action):
    """Contents of a launch file."""

    def __init__(
        self, initial_entities: Iterable[Any] | None = None, *, deprecated_reason: Any = None
    ) -> None:
        super().__init__()
        self.entities = list(initial_entities or ())
        self.deprecated_reason = deprecated_reason

    def add_action(self, action: Any) -> None:
        """Append an action."""
        self.entities.append(action)

    add_entity = add_action

    @override
    def execute(self, context: LaunchContext) -> None:
        visit_all(context, self.entities)


class DeclareLaunchArgument(Action):
    """`arg`: an argument of the launch file."""

    def __init__(
        self,
        name: str,
        *,
        default_value: Any = None,
        description: Any = None,
        choices: Iterable[str] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.name, self.default_value, self.description = name, default_value, description
        self.choices = list(choices) if choices is not None else None

    @override
    def execute(self, context: LaunchContext) -> None:
        context.declared.add(self.name)
        values = context.launch_configurations
        if self.name not in values:
            if self.default_value is None:
                expected = f"a value for the launch argument '{self.name}', in launch_arguments"
                raise LaunchFileError(expected, "none, and it has no default", self.name)
            values[self.name] = text_or_missing(context, self.default_value)
        if self.choices is None:
            return
        if (chosen := unavailable.available(values[self.name])) not in self.choices:
            raise LaunchFileError(f"one of {', '.join(self.choices)}", f"'{chosen}'", self.name)


class SetLaunchConfiguration(Action):
    """`let`."""

    def __init__(self, name: Any, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = name, value

    @override
    def execute(self, context: LaunchContext) -> None:
        name = perform(context, self.name)
        context.launch_configurations[name] = text_or_missing(context, self.value)


class SetEnvironmentVariable(Action):
    """`set_env`: for processes started later."""

    def __init__(self, name: Any, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = name, value

    @override
    def execute(self, context: LaunchContext) -> None:
        context.scope.environment[perform(context, self.name)] = perform(context, self.value)


class GroupAction(Action):
    """`group`: actions with scoped settings."""

    def __init__(
        self,
        actions: Iterable[Any],
        *,
        scoped: Any = True,
        forwarding: Any = True,
        launch_configurations: Mapping[Any, Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.actions, self.scoped, self.forwarding = list(actions), scoped, forwarding
        self.launch_configurations = dict(launch_configurations or {})

    @override
    def execute(self, context: LaunchContext) -> None:
        values = {
            perform(context, name): text_or_missing(context, value)
            for name, value in self.launch_configurations.items()
        }
        if not self.scoped:  # launch takes any object as it is, also a substitution
            context.launch_configurations.update(values)
            visit_all(context, self.actions)
            return
        with context.scoped():
            if not self.forwarding:
                context.launch_configurations.clear()
                context.scope.environment.clear()
            context.launch_configurations.update(values)
            visit_all(context, self.actions)


class OpaqueFunction(Action):
    """Python function of the launch file that returns actions."""

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Iterable[Any] = (),
        kwargs: Mapping[str, Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.function, self.args, self.kwargs = function, tuple(args), dict(kwargs or {})

    @override
    def execute(self, context: LaunchContext) -> None:
        made = guarded(context.file, self.function, context, *self.args, **self.kwargs)
        visit_all(context, made or ())


class LogInfo(Action):
    """`log`: a message for the user."""

    def __init__(self, *, msg: Any, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.msg = msg

    @override
    def execute(self, context: LaunchContext) -> None:
        context.notice(self.line, perform(context, self.msg))


class TimerAction(Action):
    """`timer`: delayed actions."""

    def __init__(
        self,
        *,
        period: Any,
        actions: Iterable[Any],
        cancel_on_shutdown: Any = True,  # noqa: ARG002  # timers do end with the run
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.period, self.actions = period, list(actions)

    @override
    def execute(self, context: LaunchContext) -> None:
        text = str(self.period) if isinstance(self.period, (int, float)) else self.period
        period_s = coerce(perform(context, text), FLOAT)
        start = replace(context.start, delay_s=context.start.delay_s + period_s)
        actions = self.actions
        context.later.append(Later(start, context.file, lambda: visit_all(context, actions)))

    def cancel(self) -> None:
        """Do nothing: no timer runs while a launch file is read."""


def visit_all(context: LaunchContext, entities: Iterable[Any]) -> None:
    """Execute actions in order."""
    for entity in [entities] if isinstance(entities, Action) else entities:
        if isinstance(entity, (list, tuple)):
            visit_all(context, entity)
            continue
        if isinstance(entity, Substitution):
            _note_missing(context, entity)
            continue
        if not isinstance(entity, Action):
            raise LaunchFileError("a launch action", type(entity).__name__)
        entity.visit(context)


def _note_missing(context: LaunchContext, entity: Substitution) -> None:
    """Note an action that comes from something not installed, and so is left out."""
    try:
        perform(context, entity)
    except UnavailableError as error:
        context.notice(0, f"cannot run here: expected {error.expected}, found {error.found}")
    else:
        raise LaunchFileError("a launch action", type(entity).__name__)
