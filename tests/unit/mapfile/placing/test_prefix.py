# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What follows a launch prefix; tests/integration/test_run_settings.py runs nodes with some."""

from __future__ import annotations

import pytest

from rmw_manycore_py.mapfile.placing.prefix import placed_again
from rmw_manycore_py.process.scheduling import Scheduling

pytestmark = pytest.mark.unit

FIFO = Scheduling("fifo", 50)
PINNED, SCHEDULED = ("taskset", "--cpu-list", "3"), ("chrt", "--fifo", "50")


@pytest.mark.parametrize(
    ("prefix", "scheduling", "words"),
    [
        ("", FIFO, ()),
        ("gdb -ex run --args", FIFO, ()),
        ("nice -n 5", FIFO, ()),
        ("taskset -c 1", None, PINNED),
        ("/usr/bin/taskset 0x2", None, PINNED),
        ("numactl --cpunodebind=1 --membind=1", None, PINNED),
        ("nice -n 5 taskset -c 1 xterm -e", None, PINNED),
        ("chrt -f 10", None, ()),
        ("chrt -f 10", FIFO, SCHEDULED),
        ("chrt -f 10 taskset -c 1", FIFO, (*SCHEDULED, *PINNED)),
    ],
)
def test_a_prefix_that_undoes_a_placement_is_followed_by_it(
    prefix: str, scheduling: Scheduling | None, words: tuple[str, ...]
) -> None:
    assert placed_again(prefix.split(), 3, scheduling) == words
