# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many generated files, each read by us and by the real reader of its format.

Unit tests compare the first of them.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from support.comparisons.comparing import FEW, MANY, compared
from support.installs import ros2_packages


@pytest.mark.parametrize("kind", ["clouds", "definitions", "recordings"])
def test_made_files_are_read_as_by_their_real_reader(kind: str, tmp_path: Path) -> None:
    print(compared(kind, tmp_path, range(FEW, MANY)))


@pytest.mark.skipif(not ros2_packages.are_available(), reason=ros2_packages.REASON)
def test_made_launch_files_have_the_values_that_launch_gives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in ros2_packages.environment(tmp_path / "packages").items():
        monkeypatch.setenv(name, value)
    print(compared("launch_files", tmp_path, range(FEW, MANY)))
