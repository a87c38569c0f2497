# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from rmw_manycore_py.mapfile.format.model import (
    MapfileSections,
    NodeSection,
    PlatformSection,
    TopicSection,
)
from rmw_manycore_py.mapfile.schema import json_schema

pytestmark = pytest.mark.unit

DOCS = Path(__file__).parents[3] / "docs"


def test_the_schema_in_the_docs_is_current() -> None:
    """Update it with: python -m rmw_manycore_py.mapfile.schema > docs/mapfile.schema.json."""
    assert json.loads((DOCS / "mapfile.schema.json").read_text()) == json_schema()


def test_the_reference_explains_every_key() -> None:
    rows = re.compile(r"^\| `(\w+)` \|", re.MULTILINE)
    pages = sorted((DOCS / "reference" / "mapfile").glob("*.md"))
    explained = {key for page in pages for key in rows.findall(page.read_text())}
    sections = (MapfileSections, PlatformSection, TopicSection, NodeSection)
    keys = {key for section in sections for key in section.model_fields}
    assert keys <= explained
