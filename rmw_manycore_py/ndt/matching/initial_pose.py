# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finds the initial pose: alignments from many guesses; the likeliest result is chosen.

The first guesses are drawn from the given normal distribution, with any yaw; later ones around the
best results so far with decreasing deviation, which needs fewer guesses than random sampling
(Autoware uses a tree-structured Parzen estimator).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, to_rpy
from rmw_manycore_py.ndt.matching.alignment import Alignment

BEST = 5  # number of results around which later guesses are drawn
MIN_SHARE = 0.05  # deviation of the last guesses, relative to the first

Align = Callable[[Matrix], Alignment]


@dataclass(frozen=True)
class Particle:
    """A guess and the alignment from it."""

    guess: Matrix
    alignment: Alignment

    @property
    def score(self) -> float:
        """Return the likelihood used to choose the best particle."""
        return self.alignment.nearest_voxel_likelihood


def particles(
    align: Align,
    T_map_base: Matrix,
    covariance: Matrix,
    count: int,
    startup: int,
    generator: np.random.Generator,
) -> Iterator[Particle]:
    """Yield `count` alignments; the covariance (6, 6) is of x, y, z, roll, pitch, yaw."""
    mean = np.concatenate([T_map_base[:3, 3], to_rpy(T_map_base)])
    deviations = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    found: list[Particle] = []
    for index in range(count):
        if index < startup or not found:
            guess = generator.normal(mean, deviations)
            guess[5] = generator.uniform(-np.pi, np.pi)
        else:
            share = max(MIN_SHARE, 1.0 - index / count)
            guess = _near(found[index % len(found)], deviations, share, generator)
        T_guess = from_xyz_rpy(guess[:3], guess[3:])
        particle = Particle(T_guess, align(T_guess))
        found = sorted([*found, particle], key=lambda p: p.score, reverse=True)[:BEST]
        yield particle


def _near(
    particle: Particle, deviations: Matrix, share: float, generator: np.random.Generator
) -> Matrix:
    T = particle.alignment.T_map_sensor
    spread = share * np.append(deviations[:5], 0.5)
    return generator.normal(np.concatenate([T[:3, 3], to_rpy(T)]), spread)
