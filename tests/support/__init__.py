# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the suites share; here what all of them use, in rooms what some do."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

TESTS = Path(__file__).parents[1]
REPOSITORY = TESTS.parent
MAPFILES = REPOSITORY / "mapfiles"

# The middleware under test; tests of ROS 2 itself also pass with rmw_fastrtps_cpp.
RMW = os.environ.get("MANYCORE_TEST_RMW", "rmw_manycore")
IS_MANYCORE = RMW == "rmw_manycore"

# Limit for things that take milliseconds: only a failing test waits that long.
TIMEOUT_S = float(os.environ.get("MANYCORE_TEST_TIMEOUT", "60"))

# How often the stress tests kill or stop a process.
KILLS = int(os.environ.get("MANYCORE_TEST_KILLS", "1000"))


def wait_until(condition: Callable[[], Any], what: str, timeout_s: float = TIMEOUT_S) -> None:
    """Poll a condition until it holds; fail after the timeout."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"not within {timeout_s:g} s: {what}")
        time.sleep(0.01)
