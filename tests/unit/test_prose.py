# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Prose of the documentation: length of sentences, lines and all pages; origin of figures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from support import REPOSITORY

pytestmark = pytest.mark.unit

DOCS = sorted(REPOSITORY.glob("docs/**/*.md"))
PAGES = [*sorted(REPOSITORY.glob("*.md")), *DOCS]
MAX_SENTENCE_WORDS = 30
MAX_COLUMNS = 100
MAX_DOCS_WORDS = 49_200

FENCED = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)
CODE_SPAN = re.compile(r"`[^`]+`")
LINK = re.compile(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^)]*\)")
LINK_TARGET = re.compile(r"(?<=\])\([^)\s]*\)")
LIST_ITEM = re.compile(r"^\s*(?:[-*]|\d+\.)\s")
NO_PROSE = ("|", "#", "<", "!!!")
SENTENCE_END = re.compile(r"(?<=[.?!])[\"')*_]*\s+(?=[\"'(*_\[]*[A-Z0-9/])")

MEASURED = re.compile(r"\d ?(?:ns|us|ms|s|KiB|MiB|cm|m|x|%)(?!\w)|/s\b")
COMMIT_AND_DATE = re.compile(
    r"`[0-9a-f]{7,8}`[ ,(]+20\d\d-\d\d-\d\d|20\d\d-\d\d-\d\d[ ,(]+`[0-9a-f]{7,8}`"
)


def name_of(page: Path) -> str:
    return str(page.relative_to(REPOSITORY))


def paragraphs(text: str) -> Iterator[str]:
    """Yield paragraphs and list items, without headings, tables and fenced blocks."""
    lines: list[str] = []
    for line in [*FENCED.sub("\n", text).splitlines(), ""]:
        stripped = line.strip()
        prose = bool(stripped) and not stripped.startswith(NO_PROSE)
        if lines and (not prose or LIST_ITEM.match(line)):
            yield " ".join(lines)
            lines = []
        if prose:
            lines.append(LIST_ITEM.sub("", line, count=1).strip())


def sentences(text: str) -> Iterator[str]:
    """Yield sentences with code spans as one word, and links as their texts."""
    for paragraph in paragraphs(text):
        yield from SENTENCE_END.split(LINK.sub(r"\1", CODE_SPAN.sub("X", paragraph)))


def words_in(text: str) -> int:
    return sum(any(c.isalnum() for c in word) for word in text.split())


def sections_with_figures(page: Path) -> Iterator[tuple[str, str]]:
    """Yield heading and text of each section that has a table of what a bench measured."""
    introduction, *sections = re.split(r"^## ", FENCED.sub("", page.read_text()), flags=re.M)
    for section in (introduction, *sections):
        rows = [row for row in section.splitlines() if row.startswith("|")]
        of_a_bench = "manycore bench" in section or page.parent.name == "benchmarks"
        if of_a_bench and sum(bool(MEASURED.search(row)) for row in rows) > 1:
            yield section.partition("\n")[0], f"{introduction} {section}"


def test_the_parser_finds_sentences() -> None:
    text = "# No\n\nOne `a. b` [two](x.md).\nThree (*four.*)\n\n- *Five*\n  six\n- seven\n| no |"
    assert list(sentences(text)) == ["One X two.", "Three (*four.*)", "*Five* six", "seven"]


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_sentences_are_short(page: Path) -> None:
    counted = {sentence: words_in(sentence) for sentence in sentences(page.read_text())}
    assert {s: words for s, words in counted.items() if words > MAX_SENTENCE_WORDS} == {}


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_lines_fit_a_terminal(page: Path) -> None:
    """Link targets do not count; tables and fenced blocks may be wider."""
    lines = FENCED.sub("", page.read_text()).splitlines()
    prose = [LINK_TARGET.sub("", line) for line in lines if not line.startswith("|")]
    assert [line for line in prose if len(line) > MAX_COLUMNS] == []


def test_all_pages_together_are_short() -> None:
    words = sum(len(page.read_text().split()) for page in DOCS)
    assert words <= MAX_DOCS_WORDS, "say it in fewer words, here or on another page"


def test_figures_name_the_commit_and_date_that_they_come_from() -> None:
    found = [
        (name_of(page), heading, bool(COMMIT_AND_DATE.search(" ".join(text.split()))))
        for page in DOCS
        for heading, text in sections_with_figures(page)
    ]
    assert len(found) > 12
    assert [(page, heading) for page, heading, dated in found if not dated] == []
