# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wait for matching subscriptions of a publisher."""

from __future__ import annotations

import time
from typing import Any

from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.spinning import spin_once

# Period of the waiting message.
TOLD_PERIOD_S = 1.0


def wait_for_subscriptions(node: Any, publisher: Any, wanted: int, timeout_s: float | None) -> None:
    """Spin until that many subscriptions match.

    :raises ManycoreError: if fewer match within `timeout_s`; None waits forever.
    """
    start_s = time.monotonic()
    told = 0  # messages printed, one per second
    while (found := publisher.get_subscription_count()) < wanted:
        waited_s = time.monotonic() - start_s
        if told and timeout_s is not None and waited_s >= timeout_s:
            raise ManycoreError(
                f"Timed out waiting for subscribers: Expected {wanted} subscribers "
                f"but only got {found} subscribers"
            )
        if waited_s >= told * TOLD_PERIOD_S:
            echo(f"Waiting for at least {wanted} matching subscription(s)...")
            told += 1
        spin_once(node)
