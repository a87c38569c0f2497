# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Waits of selectors, whose kernel interface takes 24.8 days at most."""

from __future__ import annotations

import math
import os
import selectors
import time

import pytest

from rmw_manycore_py.process.waits import wait_until_s

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("left_s", [-1.0, 60.0, 720 * 3600.0, 1e12, math.inf])
def test_a_selector_takes_any_wait(left_s: float) -> None:
    with selectors.DefaultSelector() as selector:
        ready = os.eventfd(1)
        selector.register(ready, selectors.EVENT_READ)
        assert selector.select(wait_until_s(time.monotonic() + left_s))
        os.close(ready)


def test_only_infinity_is_without_end() -> None:
    assert wait_until_s(math.inf) is None
    assert wait_until_s(time.monotonic() - 1) == 0
    assert 59 < (wait_until_s(time.monotonic() + 60) or 0) <= 60
