# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated clouds are read as by PCL and Open3D; damaged ones give an error in a line."""

from __future__ import annotations

from pathlib import Path

import pytest

from support.comparisons.comparing import FEW, compared

pytestmark = pytest.mark.unit


def test_made_clouds_are_read_as_by_their_real_readers(tmp_path: Path) -> None:
    counted = compared("clouds", tmp_path, range(FEW))
    assert sum(counted.values()) == FEW
    assert counted["PCD read, PLY read"] > FEW / 4, counted
    assert counted["PCD refused, PLY refused"] > FEW / 50, counted
