# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Hashes of types (REP 2016) as a DDS domain tells them."""

from __future__ import annotations

from typing import Any

_VERSION_1 = "RIHS01_"


def type_hash_of(endpoint: Any) -> str:
    """Return the hash of an endpoint's type; "" where its middleware tells none."""
    text = str(endpoint.topic_type_hash)
    return text if text.startswith(_VERSION_1) else ""
