# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A second look at a scan whose first result is not convincing: coarser levels, other guesses.

```
 first result ── unconvincing ─► wide levels, from the guess ── unconvincing ─► from beside it ...
      │ convincing                      │ convincing                                │
      └─────────► result                └─────────► result        the best fit of all ◄┘
```

If that does not convince, :meth:`Matcher.align` searches the places around the guess (places.py).
The roll and pitch of the best result so far are used: the ground determines them, also where the
place is wrong.

All decisions depend on the results alone and are taken in a fixed order, so the answer is the same
for any number of workers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from rmw_manycore_py.ndt.geometry.arrays import Pose
from rmw_manycore_py.ndt.matching.alignment import Alignment

# Minimum known fit of an unconfirmed result, as a share of the map's own score.
# `manycore bench ndt --only trust` chooses it anew for first poses, leaving out each drive in turn.
CONVINCING_SHARE = 0.90
# Ahead, behind, left and right of the guess. Of 2, 3 and 4 m, tried by hand, 4 m converged most
# often from 5 m and 20 degrees, in recorded scans and in synthetic streets.
BESIDE_M = 4.0

AlignWidely = Callable[[Pose, float], Alignment]
Convinces = Callable[[Alignment], bool]


def best_of_second_look(
    first: Alignment, guess: Pose, align_widely: AlignWidely, convinces: Convinces
) -> Alignment:
    """Return the first result that convinces, else the best fit, `first` included.

    :param guess: (4, 4) T_map_sensor that `first` was aligned from.
    :param align_widely: aligns from a guess, beginning with the wide levels; ends before the finest
        level unless the others lead to a better score there than given.
    """
    reached = first.first.score

    def aligned(start: Pose) -> Alignment:
        nonlocal reached
        found = align_widely(start, reached)
        reached = max(reached, found.first.score)
        return found

    return best_of(first, map(aligned, _starts(guess)), convinces)


def best_of(first: Alignment, others: Iterable[Alignment], convinces: Convinces) -> Alignment:
    """Return the first of other results that convinces, else the best fit, `first` included."""
    best, looks = first, first.looks
    for found in others:
        looks += 1
        if found.known_fit > best.known_fit:
            best = found
            if convinces(best):
                break
    return replace(best, looks=looks)


def _starts(guess: Pose) -> Iterator[Pose]:
    yield guess
    for axis in (0, 1):
        for side in (BESIDE_M, -BESIDE_M):
            beside = guess.copy()
            beside[:3, 3] += side * guess[:3, axis]
            yield beside
