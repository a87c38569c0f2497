# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Command groups that import commands lazily and report errors without tracebacks."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem
from typing_extensions import override

from rmw_manycore_hook import raise_on_interrupt
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.errors import EXIT_INTERRUPTED, reported
from rmw_manycore_py.errors.suggestions import did_you_mean

MAX_SUMMARY = 50  # characters of a command's first sentence


class LazyGroup(click.Group):
    """Maps each command to where it is defined: "package.module:attribute".

    Commands whose module is not installed are hidden. For commands in `until_ctrl_c`, Ctrl-C is the
    normal way to end, also during start-up; for the others it is a failure. `sections` are the
    headings of the help, with their commands.
    """

    def __init__(
        self,
        *args: Any,
        commands_at: dict[str, str],
        until_ctrl_c: tuple[str, ...] = (),
        sections: Mapping[str, Sequence[str]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(*args, **kwargs)
        self._commands_at = commands_at
        self._until_ctrl_c = until_ctrl_c
        self._sections = sections or {"Commands": tuple(commands_at)}

    @override
    def list_commands(self, ctx: click.Context) -> list[str]:
        return [name for name, place in self._commands_at.items() if _is_installed(place)]

    @override
    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        installed = self.list_commands(ctx)
        width = max(map(len, installed), default=0)
        for heading, names in self._sections.items():
            rows = [
                (name.ljust(width), self._summary(ctx, name)) for name in names if name in installed
            ]
            if rows:
                with formatter.section(heading):
                    formatter.write_dl(rows)

    def _summary(self, ctx: click.Context, name: str) -> str:
        """Return a command's first sentence, read: importing all takes most of a second."""
        text = _docstring(self._commands_at[name])
        command = self.get_command(ctx, name) if text is None else click.Command(name, help=text)
        return "" if command is None else command.get_short_help_str(MAX_SUMMARY)

    @override
    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        place = self._commands_at.get(cmd_name)
        if place is None or not _is_installed(place):
            return None
        module, _, attribute = place.partition(":")
        command = getattr(importlib.import_module(module), attribute)
        assert isinstance(command, click.Command)
        if command.help is None:  # `python -OO` and PYTHONOPTIMIZE=2 drop docstrings
            command.help = _docstring(place)
        return command

    @override
    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name = args[0]
        ctx.invoked_subcommand = name  # needed while its module is imported
        command = self.get_command(ctx, name)
        if command is None and not name.startswith("-") and not ctx.resilient_parsing:
            ctx.fail(f"No such command '{name}'{did_you_mean(name, self.list_commands(ctx))}")
        return super().resolve_command(ctx, args)

    @override
    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem[str]]:
        """Complete verbs without importing their modules, which click does for the help texts."""
        verbs = [
            CompletionItem(name) for name in self.list_commands(ctx) if name.startswith(incomplete)
        ]
        return [*verbs, *click.Command.shell_complete(self, ctx, incomplete)]

    @override
    def main(self, *args: Any, **kwargs: Any) -> Any:
        try:
            return super().main(*args, **kwargs)
        except Exception as error:
            known = reported(error)
            if known is None:
                raise
            with suppress(OSError):
                echo(f"manycore: {known}", err=True)
            sys.exit(known.exit_status)

    @override
    def invoke(self, ctx: click.Context) -> Any:
        try:
            raise_on_interrupt()
            return super().invoke(ctx)
        except KeyboardInterrupt:  # click would turn it into a failure
            ctx.exit(0 if ctx.invoked_subcommand in self._until_ctrl_c else EXIT_INTERRUPTED)


def _is_installed(place: str) -> bool:
    try:
        return importlib.util.find_spec(place.partition(":")[0]) is not None
    except ModuleNotFoundError:
        return False  # the parent package is missing, too


def _docstring(place: str) -> str | None:
    """Return that of a function in the source of a module; None if it is no function there."""
    module, _, attribute = place.partition(":")
    spec = importlib.util.find_spec(module)
    if spec is None or spec.origin is None:
        return None
    for node in ast.parse(Path(spec.origin).read_bytes()).body:
        if isinstance(node, ast.FunctionDef) and node.name == attribute:
            return ast.get_docstring(node)
    return None
