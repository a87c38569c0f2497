# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated definitions are read or refused as by rosidl."""

from __future__ import annotations

from pathlib import Path

import pytest

from support.comparisons.comparing import FEW, compared

pytestmark = pytest.mark.unit


def test_made_definitions_are_read_as_by_rosidl(tmp_path: Path) -> None:
    counted = compared("definitions", tmp_path, range(FEW))
    assert min(counted["accepted"], counted["refused"]) > FEW / 4, counted
