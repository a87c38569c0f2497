# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore completion`."""

from __future__ import annotations

import os
from pathlib import Path

import click
from click.shell_completion import get_completion_class

from rmw_manycore_py.cli.common.options import examples

# Shells that click supports, and how each loads the completion script at start-up.
SHELLS = {
    "bash": ('eval "$(manycore completion bash)"', "~/.bashrc"),
    "zsh": ('eval "$(manycore completion zsh)"', "~/.zshrc, after compinit"),
    "fish": ("manycore completion fish | source", "~/.config/fish/config.fish"),
}
PROGRAM = "manycore"
VARIABLE = "_MANYCORE_COMPLETE"  # name defined by click


@click.command(
    "completion",
    epilog=examples(
        "manycore completion",
        *(line for line, _ in SHELLS.values()),
    ),
)
@click.argument("shell", type=click.Choice(tuple(SHELLS)), required=False)
@click.pass_context
def command(context: click.Context, shell: str | None) -> None:
    """Print the completion script for SHELL.

    Without SHELL, print how to enable it. Completes verbs, options, nodes, topics, services and
    actions of the running platform, types, packages, mapfiles and platforms.
    """
    if shell is None:
        click.echo(_instructions(Path(os.environ.get("SHELL", "")).name))
        return
    completion = get_completion_class(shell)
    assert completion is not None, shell
    root = context.find_root().command
    click.echo(completion(root, {}, PROGRAM, VARIABLE).source())


def _instructions(own_shell: str) -> str:
    """Return the instructions for the user's shell, or for all if it is not supported."""
    wanted = {own_shell: SHELLS[own_shell]} if own_shell in SHELLS else SHELLS
    return "\n".join(
        f"{shell}, for this shell only:\n    {line}\n"
        f"{shell}, permanently: add the same line to {file}"
        for shell, (line, file) in wanted.items()
    )
