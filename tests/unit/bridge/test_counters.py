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
    assert third.rows[0].last_passed == third.last_numbers[0] == {gid(1): 8, gid(2): 3}


def test_the_file_grows_with_its_publishers(created: Create, tmp_path: Path) -> None:
    """Of more than it has room for, the first give way."""
    path = tmp_path / "bridge-inward-0"
    rows = created(path, CHATTER, NEWS).rows
    for number in range(1, 1000):
        for row in rows:
            row.note_last(gid(number), number)
    everything = {gid(number): number for number in range(1, 1000)}
    second = created(path, CHATTER, NEWS)
    assert [row.last_passed for row in second.rows] == [everything, everything]
    for number in range(1, 10_000):
        second.rows[0].note_last(gid(number), number + 1)
    kept = second.rows[0].last_passed
    assert len(kept) > 2000
    assert kept == {gid(n): n + 1 for n in range(10_000 - len(kept), 10_000)}
    assert second.rows[1].last_passed == {}
    found = CounterFile.open(path)
    assert found is not None
    assert found.last_numbers == [kept, {}]
    assert [row.as_dict()["reason"] for row in second.rows] == ["", ""]


def test_what_a_replaced_process_missed_is_counted(created: Create, tmp_path: Path) -> None:
    path = tmp_path / "bridge-inward-0"
    rows = created(path, CHATTER, NEWS).rows
    for row, state in zip(rows, ("forwarding", "ready"), strict=True):
        row.note_last(gid(1), 7)
        row.note_last(gid(2), 7)
        row.set_state(state)
    second = created(path, CHATTER, NEWS).rows
    for row in second:
        row.note_last(gid(1), 7)  # latched, again
        row.note_last(gid(1), 11)
        row.note_last(gid(1), 15)  # other gaps are not found here
    assert [row.as_dict()["lost"] for row in second] == [3, 0]
    second[0].rest()
    second[0].note_last(gid(2), 11)
    assert second[0].as_dict()["lost"] == 3


def test_a_route_remembers_its_latest_publishers(created: Create, tmp_path: Path) -> None:
    """Messages of those before the present one may be in flight."""
    row = created(tmp_path / "bridge-inward-0", CHATTER).rows[0]
    for number in range(1, 10):
        row.add_gid(gid(number))
    assert [number for number in range(1, 10) if row.has_gid(gid(number))] == [6, 7, 8, 9]
