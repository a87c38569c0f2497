# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many generated files, each read by us and by the real reader of its format."""

from __future__ import annotations

from pathlib import Path

import pytest
from comparing import MANY, compared


@pytest.mark.parametrize("kind", ["clouds", "definitions", "recordings"])
def test_made_files_are_read_as_by_their_real_reader(kind: str, tmp_path: Path) -> None:
    print(compared(Path(__file__).parents[1] / f"{kind}_compared.py", tmp_path, MANY))
