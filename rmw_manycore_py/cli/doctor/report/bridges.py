# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Counters of the bridges of this user's platforms."""

from __future__ import annotations

from typing import Any


def bridges() -> list[dict[str, Any]]:
    """Return the routes and counters of each platform with a bridge."""
    from rmw_manycore_bridge.status import status
    from rmw_manycore_py.cli.common.view import platform_names

    return [{"platform": n, "routes": rows} for n in platform_names() if (rows := status(n))]
