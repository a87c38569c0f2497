# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One look at a running platform."""

from __future__ import annotations

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.platform.monitor.watch import Look, Watch


def look_at(platform: str, watch: Watch) -> Look:
    """Return the current look; raise ManycoreError if the platform has ended."""
    with translate_native_errors():
        look = watch.look()
    if look is None:
        raise ManycoreError(f"platform {platform} has ended")
    return look
