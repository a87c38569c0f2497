# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A platform whose files are removed while it runs, as systemd-logind does at logout."""

from __future__ import annotations

import shutil
import sys

import pytest

from support import wait_until
from support.processes.inspection import has_receive_threads
from support.processes.platforms import PLATFORMS
from support.sources.advice import run_quoted

pytestmark = pytest.mark.integration
EXAMPLES = "rmw_manycore_py.examples"
NAMES = ("talker", "listener")


def test_nodes_end_and_say_why_and_new_ones_meet(start, platform):
    talker, listener = (
        [sys.executable, "-m", f"rmw_manycore_py.examples.{name}"]
        for name in ("talker", "listener")
    )
    old = [start(talker), start(listener, 2)]
    old[1].wait_for("I heard")
    wait_until(lambda: has_receive_threads(platform), "no process adds files any more")
    shutil.rmtree(PLATFORMS / platform)
    for program in old:
        assert program.wait() != 0, program
        assert "restart this process" in program.output
        assert " logout: " in run_quoted(program.output, "manycore doctor")
    wait_until(lambda: not (PLATFORMS / platform).exists(), "the old ones leave nothing")
    start(talker)
    start(listener, 2).wait_for("I heard")
