# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The commands that messages of this repository's programs advise: found in sources, and run."""

from __future__ import annotations

import ast
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from support import REPOSITORY
from support.sources.texts import NATIVE, PYTHON

VALUE = "VALUE"  # in the place of what a message fills in
# Texts of the command line's own help are no messages; its examples have a test of their own.
HELP = ("examples", "option", "argument", "command", "group", "field", "Field")
PROGRAMS = ("manycore", "chmod", "kill", "mkdir", "mount", "rm", "rosbags-convert")
_QUOTED = re.compile(rf"`((?:{'|'.join(PROGRAMS)}) [^`\n]+)`|(?<![\w'])'(manycore [a-z][^'\n]*)'")
ANY = re.compile(r"(?<![\w/_.-])manycore ([a-z-]+)")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
# What may stand between two literals of one message.
JOINED = re.compile(r'"\s*(?:\+\s*(?:[^";{}]*?)\s*\+)?\s*"')


@cache
def messages() -> list[tuple[Path, str]]:
    """Return file and text of each message, VALUE for what it fills in."""
    return list(_messages())


def _messages() -> Iterator[tuple[Path, str]]:
    for folder in PYTHON:
        for file in sorted((REPOSITORY / folder).rglob("*.py")):
            for text in _of_python(ast.parse(file.read_text())):
                yield file.relative_to(REPOSITORY), text
    for folder in NATIVE:
        for file in sorted((REPOSITORY / "rmw_manycore" / folder).rglob("*.[ch]pp")):
            for text in LITERAL.findall(JOINED.sub(_join, file.read_text())):
                yield file.relative_to(REPOSITORY), text


def _join(between: re.Match[str]) -> str:
    return VALUE if "+" in between.group() else ""


def _of_python(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.JoinedStr):
        parts = (part.value if isinstance(part, ast.Constant) else VALUE for part in node.values)
        yield "".join(map(str, parts))
    elif isinstance(node, ast.Constant):
        if isinstance(node.value, str):
            yield node.value
    elif not _is_help(node):
        for child in ast.iter_child_nodes(node):
            yield from _of_python(child)


def _is_help(node: ast.AST) -> bool:
    if isinstance(node, ast.Expr):  # a docstring
        return isinstance(node.value, ast.Constant)
    if isinstance(node, ast.Call):
        name = getattr(node.func, "attr", getattr(node.func, "id", ""))
        return name in HELP
    return False


def quoted(text: str) -> list[str]:
    """Return the commands that a text quotes."""
    return [first or second for first, second in _QUOTED.findall(text)]


def run_quoted(text: str, words: str, **placeholders: object) -> str:
    """Run the last command of a text that begins with some words; return its output.

    A shell runs it, as it would run a command that is copied there.
    """
    found = [command for command in quoted(text) if command.startswith(words)]
    assert found, f"no `{words} ...` is advised by: {text}"
    command = found[-1]
    for name, value in placeholders.items():
        command = command.replace(name, shlex.quote(str(value)))
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    done = subprocess.run(
        ["sh", "-c", command], env={**os.environ, "PATH": path}, capture_output=True, text=True
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def advised() -> set[str]:
    """Return the commands that messages quote."""
    return {command for _, text in messages() for command in quoted(text)}
