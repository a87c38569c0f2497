# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Links of the documentation lead to files that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
PAGES = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]
VARIABLE = re.compile(r"\b(MANYCORE_[A-Z_]+)\b")
SUFFIXES = {".py", ".pth", ".cpp", ".hpp", ".sh"}
# Of CMake and of the preprocessor, not of the environment.
OTHERS = re.compile(
    r"MANYCORE_(BUILD_\w+|CHECK\w*|PREFIX|ROS_\w+|SANITIZE|SITE_PACKAGES|THREAD_SANITIZER|WERROR"
    r"|TRACE|WITHOUT_\w+)"
)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    links = [link for link in LINK.findall(page.read_text()) if "://" not in link]
    assert [link for link in links if not (page.parent / link).exists()] == []


def test_every_variable_of_the_environment_is_in_one_place() -> None:
    folders = ("rmw_manycore", "rmw_manycore_py", "bridge", "startup", "scripts", "tests")
    files = [f for folder in folders for f in (ROOT / folder).rglob("*") if f.suffix in SUFFIXES]
    used = {name for file in files for name in VARIABLE.findall(file.read_text())}
    page = (ROOT / "docs/cli.md").read_text()
    explained = page[page.index("## Environment variables") : page.index("## Looking at a")]
    missing = {name for name in used if f"`{name}`" not in explained}
    assert {name for name in missing if not OTHERS.fullmatch(name)} == set()
