# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Vectorized matching of events."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]  # event indices, ascending
Keys = tuple[NDArray[np.uint64], ...]  # columns, e.g. publishers and record numbers


def in_turns(begins: Indices, ends: Indices) -> tuple[Indices, Indices, Indices]:
    """Pair each end with the last begin since the previous end.

    :return: begins, their ends, and the last begin if no end follows it.
    """
    at = np.concatenate([begins, ends])
    is_begin = np.repeat([True, False], (len(begins), len(ends)))
    order = np.argsort(at, kind="stable")
    return _turns(at[order], is_begin[order])


def by_key(keys: Keys, at: Indices, is_begin: NDArray[Any]) -> tuple[Indices, Indices, Indices]:
    """Return the same as `in_turns` per key, with all begins without an end."""
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
    """Return the next index for each index, and `end` for the last."""
    return np.append(at[1:], end) if len(at) else at


def groups_of(keys: Keys) -> NDArray[np.intp]:
    """Return a group number per row; equal rows have equal numbers."""
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
    """Return the first position of each wanted row in the table; -1 if missing."""
    size = len(table[0])
    groups = groups_of(tuple(map(np.concatenate, zip(table, wanted, strict=True))))
    found = np.full(len(groups), -1)
    backwards = np.arange(size)[::-1]
    found[groups[backwards]] = backwards
    return found[groups[size:]]
