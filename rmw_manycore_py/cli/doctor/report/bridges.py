# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the bridges of this user's platforms have carried."""

from __future__ import annotations

from typing import Any


def bridges() -> list[dict[str, Any]]:
    """Return the routes of each platform that has a bridge, with their counters."""
    from rmw_manycore_bridge.status import status
    from rmw_manycore_py.cli.common.view import platform_names

    return [{"platform": n, "routes": rows} for n in platform_names() if (rows := status(n))]
