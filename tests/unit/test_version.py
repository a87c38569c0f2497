# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The version stands in rmw_manycore_py; the files that have to repeat it say the same."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import yaml

from rmw_manycore_py import __version__

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]


def test_the_package_manifest_has_it() -> None:
    assert ElementTree.parse(ROOT / "package.xml").findtext("version") == __version__


def test_the_citation_has_it() -> None:
    assert str(yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"]) == __version__


def test_it_is_the_newest_release_of_the_changelog() -> None:
    releases = re.findall(r"^## (\d\S*)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert releases[0] == __version__
