# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Common part of process actions, and processes that are not nodes."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from typing_extensions import override

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.mapfile.launch_file.actions import Action, Condition
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.events import OnProcessExit
from rmw_manycore_py.mapfile.launch_file.launched import LaunchedNode, Respawn
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import perform
from rmw_manycore_py.mapfile.launch_file.typed_values import boolean

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
        self.additional_env = additional_env
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
        own = {**dict(given.get("env") or {}), **dict(self.additional_env or {})}
        env = {perform(context, name): perform(context, value) for name, value in own.items()}
        if on_exit := given.get("on_exit"):
            OnProcessExit(target_action=self, on_exit=on_exit).register(context, self.line)
        return ProcessOptions(
            env={**context.scope.environment, **env},
            prefix=self._prefix(context, given.get("prefix")),
            cwd=perform(context, given["cwd"]) if "cwd" in given else None,
            respawn=_respawn(context, given),
            shell=bool(given.get("shell")),  # launch takes any object as it is
        )

    def _prefix(self, context: LaunchContext, given: Any) -> tuple[str, ...]:
        own = context.launch_configurations.get("launch-prefix", "")
        return tuple(shlex.split(perform(context, own if given is None else given)))

    def known(self, context: LaunchContext) -> LaunchedNode:
        """Return the known part of a process that cannot run here."""
        raise NotImplementedError

    @override
    def cannot_run(self, context: LaunchContext, problem: Problem) -> None:
        super().cannot_run(context, problem)
        context.nodes.append(replace(self.known(context), problem=problem))


def _respawn(context: LaunchContext, given: Mapping[str, Any]) -> Respawn | None:
    if not boolean(context, given.get("respawn", False)):
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
    def known(self, context: LaunchContext) -> LaunchedNode:
        words = [known_text(context, word) for word in self.cmd]
        name = None if self.exec_name is None else known_text(context, self.exec_name)
        command = tuple(word for word in words[:1] if word)
        return LaunchedNode(
            context.file,
            self.line,
            name,
            "/",
            serial=context.serial(self),
            command=command,
            start=context.start,
        )

    @override
    def execute(self, context: LaunchContext) -> None:
        options = self.evaluate_options(context)
        command = tuple(perform(context, word) for word in self.cmd)
        if not command or not command[0]:
            raise LaunchFileError("a program and its arguments", "none")
        label = None if self.exec_name is None else perform(context, self.exec_name)
        if options.shell:
            label = label or shlex.split(command[0])[0].rpartition("/")[2]
            command = ("/bin/sh", "-c", " ".join(command))
        context.nodes.append(
            LaunchedNode(
                file=context.file,
                line=self.line,
                name=label,
                namespace="/",
                command=command,
                env=options.env,
                serial=context.serial(self),
                prefix=options.prefix,
                cwd=options.cwd,
                start=context.start,
                respawn=options.respawn,
            )
        )


def known_text(context: LaunchContext, value: Any) -> str | None:
    """Return a text; None if it is missing or wrong, for a process that cannot run anyway."""
    try:
        return perform(context, value)
    except LaunchFileError:
        return None
