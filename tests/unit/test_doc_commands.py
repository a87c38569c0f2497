# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Every call of `manycore` in the documentation uses existing verbs, options and arguments."""

from __future__ import annotations

import re
from pathlib import Path

import click
import pytest

from support import REPOSITORY
from support.sources.doc_commands import manycore_calls, parse

pytestmark = pytest.mark.unit

TARGET = re.compile(r"^([a-z-]+):", re.MULTILINE)
CALL_OF_MAKE = re.compile(r"(?:^|`)make (?!-)([\w./-]+)", re.MULTILINE)
PAGES = [
    REPOSITORY / "README.md",
    REPOSITORY / "CONTRIBUTING.md",
    *sorted(REPOSITORY.glob("docs/**/*.md")),
]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(REPOSITORY)))
def test_calls_in_the_documentation_parse(page: Path) -> None:
    wrong = []
    for arguments in manycore_calls(page):
        try:
            parse(arguments)
        except (click.ClickException, AssertionError) as error:
            wrong.append((arguments, getattr(error, "message", str(error))))
    assert wrong == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(REPOSITORY)))
def test_targets_of_make_exist(page: Path) -> None:
    targets = TARGET.findall((REPOSITORY / "Makefile").read_text())
    assert set(CALL_OF_MAKE.findall(page.read_text())) <= {*targets, ".venv/tests"}


@pytest.mark.parametrize(
    "arguments",
    [["rum", "map.yaml"], ["run"], ["run", "--fast", "map.yaml"], ["stop", "--now", "--wait", "3"]],
)
def test_a_wrong_call_does_not(arguments: list[str]) -> None:
    with pytest.raises((click.ClickException, AssertionError)):
        parse(arguments)
