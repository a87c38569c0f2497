# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A group of commands that are imported when they are called, and errors without tracebacks."""

from __future__ import annotations

import importlib
import importlib.util
from typing import Any

import click
from typing_extensions import override

from rmw_manycore_py.errors import ManycoreError


class LazyGroup(click.Group):
    """Its commands are the attributes `command` of modules, in the order they are given in.

    A command whose module is not installed does not exist.
    """

    def __init__(self, *args: Any, modules: dict[str, str], **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._modules = modules

    @override
    def list_commands(self, ctx: click.Context) -> list[str]:
        return [name for name, module in self._modules.items() if _is_installed(module)]

    @override
    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        module = self._modules.get(cmd_name)
        if module is None or not _is_installed(module):
            return None
        command = importlib.import_module(module).command
        assert isinstance(command, click.Command)
        return command

    @override
    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except ManycoreError as error:
            click.echo(f"manycore: {error}", err=True)
            ctx.exit(error.exit_status)


def _is_installed(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:
        return False  # not even the package around it
