# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Marks the tests of this directory: they are long, random or fill the machine."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from running_time import RunningTime


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker("stress")


@pytest.fixture
def running_time() -> Iterator[RunningTime]:
    clock = RunningTime()
    yield clock
    clock.stop()
