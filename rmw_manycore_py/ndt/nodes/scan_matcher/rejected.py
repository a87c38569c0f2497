# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reason why a scan or a request yields no pose."""

from __future__ import annotations


class Rejected(Exception):  # noqa: N818
    """A scan or request yields no pose; the message has the reason."""
