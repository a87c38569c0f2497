# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Whether this process is part of a run in virtual time (docs/design/virtual_time.md)."""

from __future__ import annotations

import os


def lives_in_virtual_time() -> bool:
    """Return whether time.time() and time.sleep() are virtual once this process has joined."""
    return "MANYCORE_VIRTUAL_TIME" in os.environ
