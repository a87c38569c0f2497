# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The page on the thesis states what the model of Bostan finds: it does not depend on a machine."""

from __future__ import annotations

import re

import pytest

from rmw_manycore_py.bench.relations import Relation, measured_relations
from rmw_manycore_py.papers.thesis.matrix import claims as matrix_claims
from rmw_manycore_py.papers.thesis.matrix import model as matrix_model
from rmw_manycore_py.papers.thesis.noc import claims as noc_claims
from rmw_manycore_py.papers.thesis.noc import model as noc_model
from rmw_manycore_py.papers.thesis.noc.cases import SIZES
from rmw_manycore_py.prediction.bostan.parameters import Parameters
from support import REPOSITORY

pytestmark = pytest.mark.unit

PAGE = REPOSITORY / "docs/reference/benchmarks/thesis.md"
ROW = re.compile(r"^\| ([A-Z]\d\w?) \| [^|]+ \| (yes|no), ([^|]+) \|", re.MULTILINE)
NUMBER = re.compile(r"\d+(?:\.\d+)?")
MATRIX_SIZES = (280, 400)


def relations() -> list[Relation]:
    """Return what holds in the model with its default parameters."""
    transfers = noc_model.ModelTimes(SIZES, Parameters())
    products = matrix_model.ModelTimes(MATRIX_SIZES, Parameters())
    return [
        *measured_relations(noc_claims.CLAIMS, transfers),
        *measured_relations(noc_model.PUBLISHED, transfers),
        *measured_relations(matrix_claims.CLAIMS, products),
    ]


def test_the_page_has_the_figures_of_the_model() -> None:
    rows = {name: (verdict, text) for name, verdict, text in ROW.findall(PAGE.read_text())}
    found = {relation.name: relation for relation in relations()}
    assert {name: verdict == "yes" for name, (verdict, _) in rows.items()} == {
        name: relation.holds for name, relation in found.items()
    }
    for name, (_, text) in rows.items():
        numbers = set(NUMBER.findall(text.replace("10 KB", "").replace("100 B", "")))
        assert numbers, name
        assert numbers <= set(NUMBER.findall(found[name].found)), name
