# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Commands that messages advise are complete: they can be run as they are quoted.

Tests of tests/integration run them in the states whose messages name them (`follow`, `cure`).
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
from pathlib import Path

import click
import pytest

from rmw_manycore_py.cli.main import VERBS
from support.sources.advice import PROGRAMS, advised, messages
from support.sources.doc_commands import parse

pytestmark = pytest.mark.unit

CALL = re.compile(
    rf"(?<![\w/.-])(?:manycore (?:{'|'.join(VERBS)})\b|(?:{'|'.join(PROGRAMS[1:])}) [-\d])"
)
QUOTE = re.compile(r"[`'\"(]$")
# Names of programs, without what a call of them needs.
NOUNS = {"manycore run", "manycore up", "manycore interface build", "manycore advise"}
PROSE = re.compile(
    r"manycore view|manycore create; do not edit|written by manycore create|by manycore trace save|"
    r"of manycore trace save|what manycore trace save|# manycore trace |# With manycore run|"
    r"# Report of manycore doctor|in the background: manycore|next: manycore whill drive"
)


def test_every_command_that_is_quoted_can_be_called() -> None:
    wrong = []
    commands = advised() - NOUNS
    for command in commands:
        program, *arguments = shlex.split(command)
        if program != "manycore":
            path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
            assert shutil.which(program, path=path), f"a message advises {command}"
            continue
        try:
            parse(arguments)
        except (click.ClickException, AssertionError) as error:
            wrong.append((command, getattr(error, "message", str(error))))
    assert len(commands) > 20
    assert wrong == []


def test_no_command_is_advised_without_quotes() -> None:
    """Else nothing says where it ends, and the test above does not see it."""
    assert [
        (str(file), text)
        for file, text in messages()
        if "bench" not in file.parts
        for call in CALL.finditer(text)
        if call.start() > 0 and not QUOTE.search(text[: call.start()]) and not PROSE.search(text)
    ] == []
