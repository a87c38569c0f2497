# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Whether the lists of a profile fit together: other programs write profiles, too."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

from pydantic import BaseModel

from rmw_manycore_py.profile.model import Profile

# Lists of a profile, by the keys that hold positions in them.
_LISTS = {
    "process": "processes",
    "node": "nodes",
    "publisher": "publishers",
    "subscription": "subscriptions",
    "executor": "executors",
    "group": "groups",
}


class Misfit(NamedTuple):
    """A key of a profile that does not fit the rest."""

    key: str
    expected: str
    found: str


def misfits_of(profile: Profile) -> Iterator[Misfit]:
    """Yield positions that a list does not have, and distributions without a value per share."""
    shares = profile.quantile_shares
    is_ascending = all(low < high for low, high in pairwise(shares))
    if not (shares and is_ascending and shares[0] >= 0 and shares[-1] <= 1):
        yield Misfit("quantile_shares", "shares from 0 to 1, ascending", str(list(shares)))
    counts = {key: len(getattr(profile, name)) for key, name in _LISTS.items()}
    for path, key, value in _values(profile):
        if key in counts and value is not None and value >= counts[key]:
            expected = f"a position in {_LISTS[key]}, which has {counts[key]}"
            yield Misfit(path, expected, str(value))
        elif key == "quantiles" and len(value) != len(shares):
            yield Misfit(path, f"{len(shares)} values, as quantile_shares", str(len(value)))


def _values(row: BaseModel, prefix: str = "") -> Iterator[tuple[str, str, Any]]:
    """Yield path, key and value of what a row holds, at any depth."""
    for key in type(row).model_fields:
        value, path = getattr(row, key), f"{prefix}{key}"
        if isinstance(value, BaseModel):
            yield from _values(value, f"{path}.")
        elif isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            for index, one in enumerate(value):
                yield from _values(one, f"{path}.{index}.")
        else:
            yield path, key, value
