# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated files of other writers are read as by mcap; damaged ones give an error in a line."""

from __future__ import annotations

from pathlib import Path

import pytest

from support.comparisons.comparing import FEW, compared

pytestmark = [pytest.mark.unit, pytest.mark.needs("mcap")]


def test_made_files_are_read_as_by_mcap(tmp_path: Path) -> None:
    counted = compared("recordings", tmp_path, range(FEW))
    assert sum(counted.values()) == FEW, counted
    assert sum(number for end, number in counted.items() if end.endswith("cut")) > FEW / 10, counted
    assert counted.get("damage misread, whole", 0) < FEW / 50, counted
