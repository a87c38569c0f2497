# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Type hashes (REP 2016) announced in a DDS domain."""

from __future__ import annotations

from typing import Any

_VERSION_1 = "RIHS01_"


def type_hash_of(endpoint: Any) -> str:
    """Return the type hash of an endpoint; "" if its middleware does not announce one."""
    text = str(endpoint.topic_type_hash)
    return text if text.startswith(_VERSION_1) else ""
