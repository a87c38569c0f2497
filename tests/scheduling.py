# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which worker of pytest-xdist runs which tests."""

from __future__ import annotations

from typing import Any

import pytest

# One worker runs all tests of files that begin so, as they share something that takes long to make.
TOGETHER = ("tests/integration/test_install",)


def make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Return a scheduler that hands out the tests one by one."""
    from xdist.scheduler.loadscope import LoadScopeScheduling

    class OneByOne(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return next((files for files in TOGETHER if nodeid.startswith(files)), nodeid)

    return OneByOne(config, log)
