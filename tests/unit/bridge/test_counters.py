# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Counters that a bridge process leaves for its successor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from rmw_manycore_bridge.counters import CounterFile
from rmw_manycore_py.routes.route import Route

Create = Callable[..., CounterFile]
pytestmark = pytest.mark.unit

CHATTER = Route("topic", "inward", "/chatter", "/chatter", "std_msgs/msg/String", 3)
NEWS = Route("topic", "inward", "/news", "/news", "std_msgs/msg/String", 3)


def gid(number: int) -> bytes:
    return number.to_bytes(16, "little")


@pytest.fixture
def created() -> Iterator[Create]:
    """Return a function that makes files, each of which is closed afterwards."""
    with ExitStack() as stack:

        def create(path: Path, *routes: Route) -> CounterFile:
            file = CounterFile.create(path, routes)
            stack.callback(file.close)
            return file

        yield create


def test_the_last_numbers_outlive_their_process(created: Create, tmp_path: Path) -> None:
    path = tmp_path / "bridge-inward-0"
    first = created(path, CHATTER, NEWS)
    first.rows[0].note_last(gid(1), 7)
    first.rows[0].note_last(gid(2), 3)
    first.rows[0].note_last(gid(1), 8)
    second = created(path, NEWS, CHATTER)  # the plan may differ
    assert second.rows[1].last_passed == {gid(1): 8, gid(2): 3}
    assert second.rows[0].last_passed == {}
    third = created(path, CHATTER)  # killed before a message arrived
    assert third.rows[0].last_passed == third.rows[0].last_numbers == {gid(1): 8, gid(2): 3}


def test_of_many_publishers_the_first_give_way(created: Create, tmp_path: Path) -> None:
    row = created(tmp_path / "bridge-inward-0", CHATTER).rows[0]
    for number in range(1, 18):
        row.note_last(gid(number), number)
    assert row.last_numbers == {gid(number): number for number in range(2, 18)}
    assert row.as_dict()["reason"] == ""


def test_a_route_remembers_its_latest_publishers(created: Create, tmp_path: Path) -> None:
    """Messages of those before the present one may be in flight."""
    row = created(tmp_path / "bridge-inward-0", CHATTER).rows[0]
    for number in range(1, 10):
        row.add_gid(gid(number))
    assert [number for number in range(1, 10) if row.has_gid(gid(number))] == [6, 7, 8, 9]
