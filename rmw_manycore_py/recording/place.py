# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where on a platform a recorder or player is."""

from __future__ import annotations

import os

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

_MAX_CLUSTER = 64


def own_cluster() -> int:
    """Return $MANYCORE_CLUSTER, by default 1.

    :raises ManycoreError: when it is no cluster.
    """
    text = os.environ.get("MANYCORE_CLUSTER") or "1"
    if not text.isdecimal() or not 1 <= int(text) <= _MAX_CLUSTER:
        raise ManycoreError(
            f"MANYCORE_CLUSTER: expected a number from 1 to {_MAX_CLUSTER}, found '{text}'",
            EXIT_BAD_INPUT,
        )
    return int(text)
