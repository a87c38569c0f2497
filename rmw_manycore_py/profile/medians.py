# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A profile without variation."""

from __future__ import annotations

import json
from typing import Any

from rmw_manycore_py.profile.model import Profile


def with_medians(profile: Profile) -> Profile:
    """Return a profile in which each quantity always has its median."""
    shares = profile.quantile_shares
    middle = min(range(len(shares)), key=lambda index: abs(shares[index] - 0.5))

    def flat(value: Any, key: str = "") -> Any:
        if isinstance(value, dict):
            return {key: flat(one, key) for key, one in value.items()}
        if isinstance(value, list | tuple):
            return [value[middle]] * len(value) if key == "quantiles" else [*map(flat, value)]
        return value

    return Profile.model_validate_json(json.dumps(flat(profile.model_dump())))
