# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Commands in the documentation.

A block marked `sh` is run as is: all blocks of a page, in order, are one script. A block marked
`console` shows commands after a `$`, with their output, or commands for another machine.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from itertools import takewhile
from pathlib import Path

import click

from rmw_manycore_py.cli.main import cli

BLOCK = re.compile(r"^```(sh|console)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
HERE_DOCUMENT = re.compile(r"<<'?(\w+)'?.*?\n(.*?\n)??\1\n", re.DOTALL)
SUBSTITUTION = re.compile(r"\$\(([^)]*)\)")
ENDS_OF_COMMANDS = {"&", "&&", "||", "|", ";", ">", ">>"}


def script(page: Path) -> str:
    """Return the shell commands of a page, in order."""
    return "".join(text for kind, text in BLOCK.findall(page.read_text()) if kind == "sh")


def typed_lines(page: Path) -> Iterator[str]:
    """Yield the lines typed into a shell; continued lines are joined."""
    for kind, text in BLOCK.findall(page.read_text()):
        joined = HERE_DOCUMENT.sub("\n", text).replace("\\\n", " ")
        for line in joined.splitlines():
            if kind == "sh":
                yield line
            elif line.startswith("$ "):
                yield line[2:]


def manycore_calls(page: Path) -> Iterator[list[str]]:
    """Yield the arguments of each call of `manycore`."""
    for line in typed_lines(page):
        for part in (*SUBSTITUTION.findall(line), SUBSTITUTION.sub("VALUE", line)):
            words = iter(_words(part))
            for word in words:
                if word == "manycore":
                    yield _until_end(words)


def _words(line: str) -> list[str]:
    lexer = shlex.shlex(line, posix=True, punctuation_chars=";&|>")
    lexer.whitespace_split = True
    return list(lexer)


def _until_end(words: Iterator[str]) -> list[str]:
    return list(takewhile(lambda word: word not in ENDS_OF_COMMANDS, words))


def parse(arguments: list[str]) -> None:
    """Parse a call as the command line does, without opening the files it names."""
    context, command, words = click.Context(cli, info_name="manycore"), cli, arguments
    while isinstance(command, click.Group) and words and not words[0].startswith("-"):
        name, found, words = command.resolve_command(context, words)
        assert found is not None
        context, command = click.Context(found, context, name, **found.context_settings), found
    values, left, _ = command.make_parser(context).parse_args(list(words))
    assert left == [], f"what is left over: {left}"
    for parameter in command.params:
        value = values.get(parameter.name or "")
        if isinstance(parameter, click.Argument) and parameter.required:
            given = isinstance(value, (str, tuple)) and bool(value)
            assert given, f"{parameter.make_metavar(context)} is missing"
        if isinstance(parameter.type, click.Choice) and isinstance(value, str):
            parameter.type.convert(value, parameter, context)
