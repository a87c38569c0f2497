# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many generated launch files have the values that launch gives them, as rcl reads them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import ros2_packages
from comparing import MANY
from launch_values import by_launch, by_us, write
from made_launch_values import made


@pytest.mark.skipif(not ros2_packages.are_available(), reason=ros2_packages.REASON)
def test_values_are_those_that_launch_gives(tmp_path: Path) -> None:
    environment = {**os.environ, **ros2_packages.environment(tmp_path / "packages")}
    files = [write(tmp_path, number, made(number)) for number in range(MANY)]
    found = zip(files, by_launch(files, environment), strict=True)
    wrong = [file.read_text() for file, expected in found if by_us(file) != expected]
    assert wrong == []
