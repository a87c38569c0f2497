# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Common part of process actions, and processes that are not nodes."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from typing_extensions import override

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext, LaunchFileError
from rmw_manycore_py.mapfile.launch_file.events import OnProcessExit
from rmw_manycore_py.mapfile.launch_file.launched import LaunchedNode, Respawn
from rmw_manycore_py.mapfile.launch_file.substitutions import is_true, perform

# Options without effect, since `manycore run` decides on output and signals.
_WITHOUT_EFFECT = frozenset(
    {"output", "emulate_tty", "log_cmd", "sigterm_timeout", "sigkill_timeout", "exec_name"}
    | {"output_format", "cached_output", "description", "prefix_filter", "autostart"}
)
_OPTIONS = frozenset(
    {"respawn", "respawn_delay", "respawn_max_retries", "on_exit", "prefix", "cwd", "env", "shell"}
)


@dataclass(frozen=True)
class ProcessOptions:
    """Options shared by nodes and other processes."""

    env: dict[str, str]
    prefix: tuple[str, ...]
    cwd: str | None
    respawn: Respawn | None
    shell: bool


class ProcessAction(Action):
    """Starts a process."""

    starts_process = True

    def __init__(
        self,
        *,
        additional_env: Mapping[Any, Any] | None = None,
        condition: Condition | None = None,
        **options: Any,
    ) -> None:
        super().__init__(condition=condition)
        self.additional_env = dict(additional_env or {})
        self.options = options
        self.exec_name: Any = None

    def evaluate_options(self, context: LaunchContext) -> ProcessOptions:
        """Return the options with the settings at this point of the launch file."""
        given = {name: value for name, value in self.options.items() if value is not None}
        unknown = [name for name in given if name not in _OPTIONS | _WITHOUT_EFFECT]
        if unknown:
            raise LaunchFileError(
                "an option of a node or executable", f"'{unknown[0]}'", unknown[0]
            )
        own = {**dict(given.get("env") or {}), **self.additional_env}
        env = {perform(context, name): perform(context, value) for name, value in own.items()}
        if on_exit := given.get("on_exit"):
            OnProcessExit(target_action=self, on_exit=on_exit).register(context, self.line)
        return ProcessOptions(
            env={**context.scope.environment, **env},
            prefix=self._prefix(context, given.get("prefix")),
            cwd=perform(context, given["cwd"]) if "cwd" in given else None,
            respawn=_respawn(context, given),
            shell=is_true(context, given.get("shell", False)),
        )

    def _prefix(self, context: LaunchContext, given: Any) -> tuple[str, ...]:
        own = context.launch_configurations.get("launch-prefix", "")
        return tuple(shlex.split(perform(context, own if given is None else given)))

    def label(self, context: LaunchContext) -> tuple[str | None, str]:
        """Return name and namespace as far as known."""
        return (None if self.exec_name is None else perform(context, self.exec_name)), "/"

    @override
    def cannot_run(self, context: LaunchContext, problem: Problem) -> None:
        super().cannot_run(context, problem)
        name, namespace = self.label(context)
        if name is not None:
            node = LaunchedNode(
                *(context.file, self.line, name, namespace, None, None, (), (), (), (), (), {}),
                serial=context.serial(self),
                problem=problem,
            )
            context.nodes.append(node)


def _respawn(context: LaunchContext, given: Mapping[str, Any]) -> Respawn | None:
    if not is_true(context, given.get("respawn", False) or False):
        return None
    delay, retries = given.get("respawn_delay", 0.0), given.get("respawn_max_retries", -1)
    return Respawn(number(context, delay), int(number(context, retries)))


def number(context: LaunchContext, value: Any) -> float:
    """Return a number given as number, text or substitution."""
    text = str(value) if isinstance(value, (int, float)) else perform(context, value)
    try:
        return float(text)
    except ValueError:
        raise LaunchFileError("a number", repr(text)) from None


class ExecuteProcess(ProcessAction):
    """`executable`: a process not declared as a node."""

    def __init__(self, *, cmd: Iterable[Any], name: Any = None, **options: Any) -> None:
        super().__init__(**options)
        self.cmd, self.exec_name = list(cmd), name

    @override
    def execute(self, context: LaunchContext) -> None:
        options = self.evaluate_options(context)
        command = tuple(perform(context, word) for word in self.cmd)
        if not command or not command[0]:
            raise LaunchFileError("a program and its arguments", "none")
        label = self.label(context)[0]
        if options.shell:
            label = label or shlex.split(command[0])[0].rpartition("/")[2]
            command = ("/bin/sh", "-c", " ".join(command))
        context.nodes.append(
            LaunchedNode(
                file=context.file,
                line=self.line,
                name=label,
                namespace="/",
                package=None,
                executable=None,
                command=command,
                parameters=(),
                remappings=(),
                arguments=(),
                ros_arguments=(),
                env=options.env,
                serial=context.serial(self),
                prefix=options.prefix,
                cwd=options.cwd,
                start=context.start,
                respawn=options.respawn,
            )
        )
