# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""CPU time of processes and rates of topics, as `manycore top` computes them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rmw_manycore_py.cli.top.load import Sample, process_loads, topic_loads

pytestmark = pytest.mark.unit


def endpoint(gid: bytes, kind: str, **counters: int) -> Any:
    counted = SimpleNamespace(**counters)
    return SimpleNamespace(gid=gid, kind=kind, role="topic", topic="/t", counters=counted)


def test_loads_are_differences() -> None:
    process: Any = SimpleNamespace(pid=7, label="talker", cluster=1, core=2, host_cpu=0)
    before = Sample(
        10.0,
        [process],
        [endpoint(b"a", "publisher", messages=5, bytes=50)],
        {7: 1.0, 8: 0.5},
    )
    after = Sample(
        12.0,
        [process],
        [
            endpoint(b"a", "publisher", messages=9, bytes=90),
            endpoint(b"b", "publisher", messages=2, bytes=20),
            endpoint(b"c", "subscription", messages=3, bytes=30, lost=4),
        ],
        {7: 1.5, 8: 0.5, 9: 3.0},
    )
    loads = {row["pid"]: row for row in process_loads(before, after)}
    assert [row["cpu_percent"] for row in loads.values()] == [25.0, 0.0, 0.0]
    assert (loads[7]["label"], loads[8]["label"]) == ("talker", "(receive thread)")
    (topic,) = topic_loads(before, after)
    assert topic == {"topic": "/t", "messages_per_s": 3.0, "bytes_per_s": 30.0, "lost": 4}
