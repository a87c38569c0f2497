# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A fleet has a process per node as far as the machine allows, and composes beyond that."""

from __future__ import annotations

import pytest

from rmw_manycore_py.bench.scale import fleet

pytestmark = pytest.mark.unit

GIB = 1024**3


@pytest.fixture
def available_gib(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    monkeypatch.setattr(fleet, "_available_bytes", lambda: request.param * GIB)


@pytest.mark.parametrize("available_gib", [64], indirect=True)
@pytest.mark.usefixtures("available_gib")
def test_a_node_has_a_process_of_its_own_up_to_the_limit() -> None:
    assert fleet.shares(30) == [1] * 30
    assert fleet.shares(fleet.MAX_PROCESSES) == [1] * fleet.MAX_PROCESSES


@pytest.mark.parametrize("available_gib", [64], indirect=True)
@pytest.mark.usefixtures("available_gib")
def test_more_nodes_share_the_processes_evenly() -> None:
    shares = fleet.shares(2 * fleet.MAX_PROCESSES + 1)
    assert sum(shares) == 2 * fleet.MAX_PROCESSES + 1
    assert len(shares) == fleet.MAX_PROCESSES
    assert set(shares) == {2, 3}


@pytest.mark.parametrize("available_gib", [1], indirect=True)
@pytest.mark.usefixtures("available_gib")
def test_little_memory_means_fewer_processes() -> None:
    shares = fleet.shares(fleet.MAX_PROCESSES)
    assert sum(shares) == fleet.MAX_PROCESSES
    assert len(shares) == GIB // 2 // fleet.BYTES_OF_PROCESS
