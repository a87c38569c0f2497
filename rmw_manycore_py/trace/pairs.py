# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which events belong together, found for whole columns at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]  # of events, ascending
Keys = tuple[NDArray[np.uint64], ...]  # columns, for example publishers and record numbers


def in_turns(begins: Indices, ends: Indices) -> tuple[Indices, Indices, Indices]:
    """Return each end with the last begin since the end before it.

    :return: begins, their ends, and the last begin of all where no end follows it.
    """
    at = np.concatenate([begins, ends])
    is_begin = np.repeat([True, False], (len(begins), len(ends)))
    order = np.argsort(at, kind="stable")
    return _turns(at[order], is_begin[order])


def by_key(keys: Keys, at: Indices, is_begin: NDArray[Any]) -> tuple[Indices, Indices, Indices]:
    """Return as `in_turns`, but of events of the same key; the begins without an end, too."""
    groups = groups_of(keys)
    order = np.lexsort((at, groups))
    return _turns(at[order], is_begin[order], groups[order])


def _turns(
    at: Indices, is_begin: NDArray[Any], groups: NDArray[np.intp] | None = None
) -> tuple[Indices, Indices, Indices]:
    if not len(at):
        return at, at, at
    goes_on = np.ones(len(at) - 1, bool) if groups is None else groups[1:] == groups[:-1]
    paired = np.flatnonzero(is_begin[:-1] & ~is_begin[1:] & goes_on)
    is_last = np.append(~goes_on, True)
    return at[paired], at[paired + 1], at[is_begin & is_last]


def next_of(at: Indices, end: int) -> Indices:
    """Return for each index the one after it, and `end` for the last."""
    return np.append(at[1:], end) if len(at) else at


def groups_of(keys: Keys) -> NDArray[np.intp]:
    """Return a number for each row of the keys, the same for the same row."""
    groups = np.zeros(len(keys[0]), np.intp)
    if len(groups):
        order = np.lexsort(keys)
        changes = np.any([np.diff(key[order]) != 0 for key in keys], axis=0)
        groups[order[1:]] = np.cumsum(changes)
    return groups


def split_by(groups: NDArray[Any]) -> list[Indices]:
    """Return the indices of each group, ascending."""
    order = np.argsort(groups, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(groups[order])) + 1)
    return parts if len(groups) else []


def first_of(table: Keys, wanted: Keys) -> Indices:
    """Return for each wanted row where it first stands in the table; -1 = nowhere."""
    size = len(table[0])
    groups = groups_of(tuple(map(np.concatenate, zip(table, wanted, strict=True))))
    found = np.full(len(groups), -1)
    backwards = np.arange(size)[::-1]
    found[groups[backwards]] = backwards
    return found[groups[size:]]
