# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Pages of the documentation: links, length, navigation, and coverage."""

from __future__ import annotations

import importlib.util
import json
import re
import shlex
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
import yaml

from support.sources.texts import texts

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
DOCS = sorted(ROOT.glob("docs/**/*.md"))
PAGES = [*ROOT.glob("*.md"), *DOCS]
CODE = ("rmw_manycore", "rmw_manycore_py", "bridge", "startup", "scripts", "mapfiles", "Makefile")
VARIABLE = re.compile(r"\b(MANYCORE_[A-Z_]+)\b")
SUFFIXES = {".py", ".pth", ".cpp", ".hpp", ".sh"}
# Variables of CMake and of the preprocessor, not of the environment.
OTHERS = re.compile(
    r"MANYCORE_(BUILD_\w+|CHECK\w*|PREFIX|ROS_\w+|SANITIZE|SITE_PACKAGES|THREAD_SANITIZER|WERROR"
    r"|TRACE|WITHOUT_\w+)"
)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#{1,6} (.*)$", re.MULTILINE)
FENCED = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
MENTION = re.compile(r"(?<![/\w])docs/[\w/.-]*\w")
CODE_SPAN = re.compile(r"`([^`]+)`")
ROW = re.compile(r"^\| (.*?) \| ", re.MULTILINE)
SHORTEST_PART = 6  # shorter ones match anywhere
LONGEST_PAGE_WORDS = 1500


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


def anchors(page: Path) -> set[str]:
    """Return the anchors that mkdocs generates for a page's headings."""
    found: set[str] = set()
    for heading in HEADING.findall(FENCED.sub("", page.read_text())):
        text = re.sub(r"[^\w\s-]", "", LINK.sub("]", heading).lower()).strip()
        anchor = re.sub(r"[-\s]+", "-", text)
        same = sum(1 for one in found if re.fullmatch(rf"{re.escape(anchor)}(_\d+)?", one))
        found.add(f"{anchor}_{same}" if same else anchor)
    return found


def broken(page: Path, link: str) -> bool:
    path, _, anchor = link.partition("#")
    target = page.parent / path if path else page
    if not target.exists():
        return True
    return bool(anchor) and target.suffix == ".md" and anchor not in anchors(target)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_to_files_and_headings(page: Path) -> None:
    links = [link for link in LINK.findall(page.read_text()) if "://" not in link]
    assert [link for link in links if broken(page, link)] == []


def test_pages_that_code_refers_to_exist() -> None:
    listed = subprocess.run(
        ["git", "grep", "-Ih", "docs/", "--", *CODE],
        cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE,
    ).stdout  # fmt: skip
    mentions = set(MENTION.findall(listed))
    assert {mention for mention in mentions if not (ROOT / mention).exists()} == set()


@pytest.mark.parametrize("page", DOCS, ids=name_of)
def test_a_page_can_be_read_at_a_sitting(page: Path) -> None:
    words = [word for word in page.read_text().split() if any(c.isalnum() for c in word)]
    assert len(words) <= LONGEST_PAGE_WORDS, "split it along its concepts"


def test_every_page_is_in_the_navigation_once() -> None:
    settings = yaml.safe_load((ROOT / "mkdocs.yml").read_text())
    assert sorted(pages_of(settings["nav"])) == sorted(
        str(page.relative_to(ROOT / "docs")) for page in DOCS
    )


def pages_of(part: Any) -> list[str]:
    """Return the pages in a section of the navigation."""
    if isinstance(part, str):
        return [part]
    parts = part.values() if isinstance(part, dict) else part
    return [page for one in parts for page in pages_of(one)]


def test_error_pages_quote_what_programs_print() -> None:
    """Their first columns contain error texts, with `…` for names and numbers."""
    printed = "\n".join(texts())
    quoted = {
        (page.name, part.strip())
        for page in ROOT.glob("docs/how-to/errors_*.md")
        for row in ROW.findall(page.read_text())
        for text in CODE_SPAN.findall(row)
        for part in text.split("…")
    }
    long_enough = {(page, part) for page, part in quoted if len(part) >= SHORTEST_PART}
    assert len(long_enough) > 100
    assert {(page, part) for page, part in long_enough if part not in printed} == set()


def test_the_plot_shows_the_figures_of_the_table() -> None:
    """Update it with: python scripts/plot_round_trips.py docs/pictures/round_trips.svg."""
    drawn = ElementTree.parse(ROOT / "docs/pictures/round_trips.svg")
    description = drawn.find(".//{http://purl.org/dc/elements/1.1/}description")
    assert description is not None
    assert json.loads(description.text or "") == plot_round_trips().figures()


def test_the_table_of_the_scale_bench_has_a_row_per_goal() -> None:
    """Update it with: python scripts/scale_figures.py REPORT PAGE."""
    page = (ROOT / "docs/reference/benchmarks/scale.md").read_text()
    expected = script("scale_figures").filled(page, [])
    rows, wanted = (
        [line.split(" | ")[:3] for line in text.splitlines() if line.startswith("| ")]
        for text in (page, expected)
    )
    assert rows == wanted


def plot_round_trips() -> Any:
    """Return the script as a module."""
    return script("plot_round_trips")


def script(name: str) -> Any:
    """Return a script as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / f"scripts/{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_on_apt_installs_what_apt_lacks() -> None:
    """Everything but the ROS 2 wheels, and what `apt install ros-jazzy-desktop` brings."""
    text = (ROOT / "pyproject.toml").read_text()
    listed = text.partition("\ndependencies = [")[2].partition("\n]")[0]
    by_apt = {"numpy", "pyyaml>=6", "empy==3.3.4"}
    needed = {name for name in re.findall(r'"([^"]+)"', listed) if not name.startswith("ros-")}
    page = (ROOT / "docs/how-to/ros2_apt.md").read_text()
    (line,) = re.findall(r"^\$ pip install ((?!--).*)$", page, re.MULTILINE)
    assert set(shlex.split(line)) == needed - by_apt


def test_what_the_table_of_features_calls_tested_exists() -> None:
    table = (ROOT / "docs/reference/features.md").read_text()
    paths = [text for text in CODE_SPAN.findall(table) if text.startswith(("tests/", "docs/"))]
    assert len(paths) > 30
    assert [path for path in paths if not list(ROOT.glob(path))] == []


def test_the_tables_of_folders_name_every_room_and_only_those() -> None:
    contributing = (ROOT / "CONTRIBUTING.md").read_text()
    architecture = (ROOT / "docs/explanation/architecture.md").read_text()
    lines = [line.split("   ")[0] for line in architecture.splitlines()]
    listed = {room for row in ROW.findall(contributing) for room in rooms_in(row)}
    drawn = {room for line in lines for room in rooms_in(line.replace(", ", ",").strip())}
    existing = {path.parent.name for path in ROOT.glob("rmw_manycore_py/*/__init__.py")}
    assert listed == existing
    assert "mapfile" in drawn < existing


def rooms_in(text: str) -> set[str]:
    """Return the rooms in `rmw_manycore_py/room`, `.../{room,room}` and `.../room,room`."""
    found = re.findall(r"rmw_manycore_py/\{?([a-z0-9,_]+)", text)
    return {room for names in found for room in names.split(",")} - {"__init__"}


def test_every_variable_of_the_environment_is_in_one_place() -> None:
    folders = ("rmw_manycore", "rmw_manycore_py", "bridge", "startup", "scripts", "tests")
    files = [f for folder in folders for f in (ROOT / folder).rglob("*") if f.suffix in SUFFIXES]
    used = {name for file in files for name in VARIABLE.findall(file.read_text())}
    explained = (ROOT / "docs/reference/environment.md").read_text()
    missing = {name for name in used if f"`{name}`" not in explained}
    assert {name for name in missing if not OTHERS.fullmatch(name)} == set()
