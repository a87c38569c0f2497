# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fixtures of the tests of whole programs."""

from __future__ import annotations

import pytest
from bridging import Bridge


@pytest.fixture
def bridge(start, platform) -> Bridge:
    """Return the test's bridge, with which it starts nodes inside and outside."""
    return Bridge(start, platform)
