# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Waiting for the subscriptions of a publisher."""

from __future__ import annotations

import time
from typing import Any

import click

from rmw_manycore_py.cli.common.tool_node import spin_once
from rmw_manycore_py.errors import ManycoreError

# How often a waiting publisher says so.
TOLD_PERIOD_S = 1.0


def wait_for_subscriptions(
    node: Any, publisher: Any, wanted: int, patience_s: float | None
) -> None:
    """Spin until that many subscriptions match.

    :raises ManycoreError: when they do not within `patience_s`; None waits for ever.
    """
    start_s = time.monotonic()
    told = 0  # once per second
    while (found := publisher.get_subscription_count()) < wanted:
        waited_s = time.monotonic() - start_s
        if told and patience_s is not None and waited_s >= patience_s:
            raise ManycoreError(
                f"Timed out waiting for subscribers: Expected {wanted} subscribers "
                f"but only got {found} subscribers"
            )
        if waited_s >= told * TOLD_PERIOD_S:
            click.echo(f"Waiting for at least {wanted} matching subscription(s)...")
            told += 1
        spin_once(node)
