# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Distribution of tests over the workers of pytest-xdist."""

from __future__ import annotations

from typing import Any

import pytest

# One worker runs all tests of files with these prefixes: they share an expensive fixture.
TOGETHER = ("tests/integration/test_install", "tests/integration/test_interface_build.py")


def make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Return a scheduler that hands out the tests one by one."""
    from xdist.scheduler.loadscope import LoadScopeScheduling

    class OneByOne(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return next((files for files in TOGETHER if nodeid.startswith(files)), nodeid)

    return OneByOne(config, log)
