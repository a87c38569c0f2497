# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Distribution of tests over the workers of pytest-xdist."""

from __future__ import annotations

from typing import Any

import pytest

# One worker runs all tests of files with one of these prefixes: they share an expensive fixture.
TOGETHER = tuple(
    f"tests/integration/test_{name}" for name in ("install", "interface_build.py", "view_")
)
# Begun first: one that takes a minute and begins last keeps the other workers waiting.
FIRST = ("tests/integration/test_doc_scripts.py", *TOGETHER)


def begin_with_longest(items: list[pytest.Item]) -> None:
    """Sort tests as they are handed out."""
    items.sort(key=lambda item: not item.nodeid.startswith(FIRST))


def make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Return a scheduler that hands out the tests one by one."""
    from xdist.scheduler.loadscope import LoadScopeScheduling

    class OneByOne(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return next((files for files in TOGETHER if nodeid.startswith(files)), nodeid)

    return OneByOne(config, log)
