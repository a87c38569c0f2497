# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Event handlers of launch and launch_ros: actions after the start or end of a process.

No event happens while a launch file is read. The actions of handlers for process starts and ends
are recorded with that condition; other handlers are skipped with a notice.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition, OpaqueFunction, visit_all
from rmw_manycore_py.mapfile.launch_file.context import Later, LaunchContext
from rmw_manycore_py.mapfile.launch_file.launched import Start
from rmw_manycore_py.mapfile.launch_file.substitution import perform


class Event:
    """Event of launch; only holds its arguments."""

    def __init__(self, **described: Any) -> None:
        vars(self).update(described)


class Shutdown(Event):
    """Ends the launch."""


class ChangeState(Event):
    """Requests a transition of lifecycle nodes."""

    lifecycle_node_matcher: Any
    transition_id: int


class StateTransition(Event):
    """A lifecycle node has reached a state."""


class ShutdownProcess(Event):
    """Ends a process."""


class SignalProcess(Event):
    """Sends a signal to a process."""

    def __init__(self, *, signal_number: Any = None, **described: Any) -> None:
        super().__init__(signal=signal_number, **described)


class EventHandler:
    """Actions for an event; `matcher` and class select the events."""

    what = "an event handler of its own kind"

    def __init__(
        self,
        *,
        matcher: Any = None,
        entities: Any = None,
        handle_once: bool = False,
        target_action: Any = None,
    ) -> None:
        self.matcher, self.entities, self.handle_once = matcher, entities, handle_once
        self.target_action = target_action

    def register(self, context: LaunchContext, line: int) -> None:
        """Record the effect of the handler."""
        context.notice(line, f"{self.what} has no effect here")

    def actions(self, context: LaunchContext, line: int) -> list[Any]:
        """Return the actions, except code that needs the event itself."""
        entities = self.entities or ()
        listed = [entities] if isinstance(entities, Action) else entities
        if callable(listed) or not isinstance(listed, Iterable):
            context.notice(line, "code that an event would call is not run here")
            return []
        kept = [one for one in listed if not isinstance(one, OpaqueFunction)]
        if len(kept) < len(list(listed)):
            context.notice(line, "code that an event would call is not run here")
        return kept


class _OfProcess(EventHandler):
    """Handler of the start or end of a process, or of all processes started so far."""

    on_exit = False

    @override
    def register(self, context: LaunchContext, line: int) -> None:
        actions = self.actions(context, line)
        if not actions:
            return
        if isinstance(self.target_action, Action):
            self._add(context, context.serial(self.target_action), actions)
            return

        def visit_for_first() -> None:
            matches = self.target_action or (lambda _action: True)
            by_serial = dict(context.serials.values())
            found = [n.serial for n in context.nodes if matches(by_serial.get(n.serial))]
            if found:
                self._add(context, found[0], actions)

        context.later.append(Later(Start(), context.file, visit_for_first))

    def _add(self, context: LaunchContext, serial: int, actions: list[Any]) -> None:
        start = Start(after=serial, on_exit=self.on_exit)
        context.later.append(Later(start, context.file, lambda: visit_all(context, actions)))


class OnProcessStart(_OfProcess):
    """Runs actions after a process has started."""

    def __init__(self, *, on_start: Any = None, target_action: Any = None, **named: Any) -> None:
        super().__init__(entities=on_start, target_action=target_action, **named)


class OnProcessExit(_OfProcess):
    """Runs actions after a process has ended."""

    on_exit = True

    def __init__(self, *, on_exit: Any = None, target_action: Any = None, **named: Any) -> None:
        super().__init__(entities=on_exit, target_action=target_action, **named)


class OnExecutionComplete(EventHandler):
    """Runs actions after an action is complete: when its process ends, else at once."""

    def __init__(
        self, *, on_completion: Any = None, target_action: Any = None, **named: Any
    ) -> None:
        super().__init__(entities=on_completion, target_action=target_action, **named)

    @override
    def register(self, context: LaunchContext, line: int) -> None:
        if isinstance(self.target_action, Action) and self.target_action.starts_process:
            OnProcessExit(on_exit=self.entities, target_action=self.target_action).register(
                context, line
            )
            return
        actions = self.actions(context, line)
        start = context.start
        context.later.append(Later(start, context.file, lambda: visit_all(context, actions)))


class OnShutdown(EventHandler):
    """Runs actions at shutdown."""

    what = "what is done on shutdown"

    def __init__(self, *, on_shutdown: Any = None, **named: Any) -> None:
        super().__init__(entities=on_shutdown, **named)


class OnProcessIO(EventHandler):
    """Runs actions on the output of a process."""

    what = "what is done with the output of a process"

    def __init__(self, *, target_action: Any = None, **_callbacks: Any) -> None:
        super().__init__(target_action=target_action)


class OnIncludeLaunchDescription(EventHandler):
    """Runs actions when a launch file is included."""


class OnStateTransition(EventHandler):
    """Runs actions when a lifecycle node reaches a state through recorded transitions."""

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: Any = None,
        goal_state: str | None = None,
        **named: Any,
    ) -> None:
        super().__init__(entities=entities, target_action=target_lifecycle_node)
        self.goal_state = goal_state
        self.is_simple = not {key for key, value in named.items() if value and key != "handle_once"}

    @override
    def register(self, context: LaunchContext, line: int) -> None:
        context.handlers.append((self, line))


# Target states of the transitions of lifecycle_msgs.
_GOALS = {1: "inactive", 2: "unconfigured", 3: "active", 4: "inactive"}


def change_state(context: LaunchContext, serials: Iterable[int], transition: int) -> None:
    """Record a transition of lifecycle nodes and the actions that follow it."""
    by_serial = dict(context.serials.values())
    for serial in serials:
        context.transitions.setdefault(serial, []).append(transition)
        goal = _GOALS.get(transition)
        for handler, line in [*context.handlers]:
            is_meant = handler.target_action is by_serial.get(serial) and handler.is_simple
            if is_meant and goal is not None and handler.goal_state == goal:
                context.handlers.remove((handler, line))
                visit_all(context, handler.actions(context, line))


class RegisterEventHandler(Action):
    """Adds an event handler."""

    def __init__(self, event_handler: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event_handler = event_handler

    @override
    def execute(self, context: LaunchContext) -> None:
        self.event_handler.register(context, self.line)


class UnregisterEventHandler(RegisterEventHandler):
    """Removes an event handler."""

    @override
    def execute(self, context: LaunchContext) -> None:
        context.notice(self.line, "event handlers stay registered here")


class EmitEvent(Action):
    """Emits an event; only shutdown and lifecycle transitions take effect."""

    def __init__(self, *, event: Any, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event = event

    @override
    def execute(self, context: LaunchContext) -> None:
        event = self.event
        if isinstance(event, ChangeState):
            start = context.start

            # Deferred, to include nodes declared after this action.
            def ask() -> None:
                change_state(context, _matching(context, event), event.transition_id)

            context.later.append(Later(start, context.file, ask))
        elif isinstance(event, Shutdown):
            end_run(context, self.line)
        else:
            context.notice(self.line, f"the event {type(event).__name__} has no effect here")


class EndLaunch(Action):
    """`shutdown`: ends the launch."""

    def __init__(self, *, reason: Any = "", condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.reason = reason

    @override
    def execute(self, context: LaunchContext) -> None:
        end_run(context, self.line)


def end_run(context: LaunchContext, line: int) -> None:
    """Record that the run ends with the process whose exit triggers this action."""
    start = context.start
    if start.after is not None and start.on_exit and not start.delay_s:
        context.ending.add(start.after)
    else:
        context.notice(line, "a shutdown takes effect only when a process ends")


def matches_action(target_action: Any) -> Any:
    """Return a matcher for an action."""
    return lambda action: action is target_action


def matches_node_name(node_name: str) -> Any:
    """Return a matcher for the full name of a node."""
    return _NodeName(node_name)


class _NodeName:
    def __init__(self, name: str) -> None:
        self.name = name


def _matching(context: LaunchContext, event: ChangeState) -> list[int]:
    matcher = event.lifecycle_node_matcher
    if isinstance(matcher, _NodeName):
        wanted = f"/{matcher.name.strip('/')}"
        return [n.serial for n in context.nodes if f"{n.namespace.rstrip('/')}/{n.label}" == wanted]
    by_serial = dict(context.serials.values())
    return [n.serial for n in context.nodes if matcher(by_serial.get(n.serial))]


class LifecycleTransition(Action):
    """Drives lifecycle nodes through transitions."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[Any],
        transition_ids: Iterable[Any],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.names, self.transition_ids = list(lifecycle_node_names), list(transition_ids)

    @override
    def execute(self, context: LaunchContext) -> None:
        names = [perform(context, name) for name in self.names]
        numbers = [
            int(n if isinstance(n, int) else perform(context, n)) for n in self.transition_ids
        ]

        def ask() -> None:
            for number in numbers:
                for name in names:
                    event = ChangeState(lifecycle_node_matcher=_NodeName(name))
                    change_state(context, _matching(context, event), number)

        context.later.append(Later(context.start, context.file, ask))
