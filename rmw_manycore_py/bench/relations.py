# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Relations that a paper states between its figures, and whether they hold here.

A relation is a function of times. On a machine it is measured. In a model it is checked for every
combination of the ends of those unpublished parameters that it depends on:

- derived: all are on one side of it, so that it holds, or does not, follows from the structure of
  the model;
- fitted: it depends on them, so it shows nothing but how they were set.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Generic, Literal, TypeVar

T = TypeVar("T")

Basis = Literal["measured", "derived", "fitted"]
# A relation leaves room on both sides: -1 is below it, 1 above, and 0 where it holds.
Side = Literal[-1, 0, 1]
Found = tuple[Side, str]


def side(value: float, *, min_value: float = -math.inf, max_value: float = math.inf) -> Side:
    """Return on which side of a range a value is, its ends included."""
    return -1 if value < min_value else 1 if value > max_value else 0


@dataclass(frozen=True)
class Relation:
    """A relation with what was found; `holds` is for the default parameters where it is a model."""

    name: str
    statement: str
    holds: bool
    found: str
    basis: Basis

    @property
    def in_words(self) -> str:
        """Whether it holds, for a table."""
        return "holds here" if self.holds else "does not hold here"


@dataclass(frozen=True)
class Claim(Generic[T]):
    """A relation to check. `test` raises KeyError where a time that it needs was not measured."""

    name: str
    statement: str
    test: Callable[[T], Found]
    parameters: tuple[str, ...] = ()

    def measured(self, times: T) -> Relation:
        """Check measured times."""
        where, found = self.test(times)
        return Relation(self.name, self.statement, where == 0, found, "measured")

    def modelled(self, default: T, others: Iterable[T]) -> Relation:
        """Check a model's times for the default parameters, and for other settings."""
        where, found = self.test(default)
        sides = [self.test(times)[0] for times in others]
        basis: Basis = "derived" if set(sides) <= {where} else "fitted"
        share = f"in {sides.count(0)} of {len(sides)} settings"
        return Relation(self.name, self.statement, where == 0, f"{found}; {share}", basis)


def modelled_relations(
    claims: Sequence[Claim[T]], default: T, corners: Callable[[tuple[str, ...]], Iterable[T]]
) -> list[Relation]:
    """Return the relations of a model whose sizes suffice for them.

    :param corners: returns the model's times at all corners of the ranges of the named parameters.
    """
    return _tested(claims, lambda claim: claim.modelled(default, corners(claim.parameters)))


def measured_relations(claims: Sequence[Claim[T]], times: T) -> list[Relation]:
    """Return the relations whose sides were all measured."""
    return _tested(claims, lambda claim: claim.measured(times))


def _tested(claims: Sequence[Claim[T]], test: Callable[[Claim[T]], Relation]) -> list[Relation]:
    found = []
    for claim in claims:
        with suppress(KeyError):  # left out by --only, or too few sizes
            found.append(test(claim))
    return found
