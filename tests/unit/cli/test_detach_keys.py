# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest

from rmw_manycore_py.cli.common.detach_keys import DetachKeys, parse_keys

pytestmark = pytest.mark.unit


def test_keys_are_written_as_docker_has_them() -> None:
    assert parse_keys("ctrl-p,ctrl-q") == b"\x10\x11"
    assert parse_keys("ctrl-],a") == b"\x1da"
    for bad in ("", "ctrl-", "ctrl-ab", "ä", "a,,b", "ctrl-1"):
        with pytest.raises(ValueError, match="expected keys such as"):
            parse_keys(bad)


@pytest.mark.parametrize(
    ("typed", "passed", "detached"),
    [
        ([b"abc"], b"abc", False),
        ([b"ab\x10\x11cd"], b"ab", True),
        ([b"\x10", b"\x11"], b"", True),
        ([b"\x10", b"x"], b"\x10x", False),
        ([b"\x10\x10\x11"], b"\x10", True),
        ([b"\x11\x10"], b"\x11", False),
    ],
)
def test_keys_are_found_in_what_is_typed(typed: list[bytes], passed: bytes, detached: bool) -> None:
    keys = DetachKeys(b"\x10\x11")
    taken = [keys.take(data) for data in typed]
    assert b"".join(data for data, _ in taken) == passed
    assert taken[-1][1] is detached
