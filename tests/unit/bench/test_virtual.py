# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What runs in virtual time are compared by."""

from __future__ import annotations

import json

import pytest

from rmw_manycore_py.bench.virtual import _messages, _printed
from support.samples.traces import US, example

pytestmark = pytest.mark.unit


def test_lines_after_the_end_are_left_out() -> None:
    lines = [
        "no stamp",
        "[INFO] [1000000004.999999999] [node]: in time",
        "[WARN] [1000000005.000000001] [node]: while the others end",
        "what rcl says of that",
    ]
    output = "\n".join(json.dumps({"event": "output", "node": "a", "line": line}) for line in lines)
    assert _printed(output, 10**18 + 5 * 10**9) == [f"a prints {line}" for line in lines[:2]]


def test_messages_after_the_end_are_left_out() -> None:
    rounds = [len(_messages(example(rounds=8), at_us * US)) for at_us in (85_000, 45_000)]
    assert rounds == [8 * 4, 4 * 4]  # published twice and taken twice in each
