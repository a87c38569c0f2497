# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Why a scan or a request gives no pose."""

from __future__ import annotations


class Rejected(Exception):  # noqa: N818
    """A scan that gives no pose, and why."""
