# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wishes of the user: nodes that stay, nodes in one cluster, nodes in different clusters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase

from rmw_manycore_py.advice.problem import Constraint, ConstraintKind, Problem
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.platform.texts import listed

_MIN_NODES: dict[ConstraintKind, int] = {"fix": 1, "together": 2, "apart": 2}
_MAX_NAMES = 5


def constraints_of(
    problem: Problem, wishes: Sequence[tuple[ConstraintKind, str]]
) -> tuple[Constraint, ...]:
    """Return wishes given as names or patterns of nodes, separated by commas.

    :raises ManycoreError: for a wish that no node, or too few, match.
    """
    found = []
    for kind, text in wishes:
        units = tuple(dict.fromkeys(_matching(problem, kind, text)))
        if len(units) < _MIN_NODES[kind]:
            raise ManycoreError(
                f"--{kind} {text}: expected at least {_MIN_NODES[kind]} nodes, found one",
                EXIT_BAD_INPUT,
            )
        found.append(Constraint(kind, f"--{kind} {text}", units))
    return tuple(found)


def _matching(problem: Problem, kind: str, text: str) -> Iterator[int]:
    names = {unit.name.lstrip("/"): i for i, unit in enumerate(problem.units) if not unit.is_bridge}
    for part in text.split(","):
        pattern = part.strip().lstrip("/")
        matching = [index for name, index in names.items() if fnmatchcase(name, pattern)]
        if not matching:
            known = listed(sorted(names), _MAX_NAMES)
            raise ManycoreError(
                f"--{kind}: no node '{part.strip()}'; the mapfile has {known}", EXIT_BAD_INPUT
            )
        yield from matching
