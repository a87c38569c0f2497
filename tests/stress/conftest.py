# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Marks the tests of this directory: they are long, random or fill the machine."""

from __future__ import annotations

import os
import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from support.nodes.graves import Graves
from support.nodes.steady_load import Load
from support.processes.running_time import RunningTime


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    here = f"{Path(__file__).parent}/"
    for item in items:
        if str(item.path).startswith(here):
            item.add_marker("stress")


@pytest.fixture
def running_time() -> Iterator[RunningTime]:
    clock = RunningTime()
    yield clock
    clock.stop()


@pytest.fixture
def seed() -> int:
    """Seed the random numbers; the output of a failed test has the seed that repeats it."""
    seed = int(os.environ.get("MANYCORE_TEST_SEED", str(random.randrange(1 << 32))))
    print(f"MANYCORE_TEST_SEED={seed}")
    random.seed(seed)
    return seed


@pytest.fixture
def load(seed, start, running_time) -> Load:
    return Load(start, running_time)


@pytest.fixture
def graves(platform: str, running_time: RunningTime) -> Graves:
    return Graves(platform, running_time)
