# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Aligns a scan, and again where the result is refused: at most sixteen times.

```
 from the guess ── refused ─► from where the motion leads ── refused ─► finest level alone
   1                            up to 3                         if the score refuses: 4
                                                            ── refused ─► second look
                                                                           up to 5
 first pose that does not fit ─► from places around the guess, up to 6 ─► the best
```

The last three pause while a search looks farther, and after scans that they did not help. So beside
load, refused scans do not keep the matcher from newer ones. A first pose that is explained, but
does not fit, is always compared.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.alignment import Alignment
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.trust.judge import PoseJudge, Verdict

OTHER_M, OTHER_RAD = 0.3, np.radians(2.0)  # minimum distance of a start from another one
VAIN_SCANS = 5  # in a row without help, after which no more is tried


@dataclass(frozen=True)
class ScanAt:
    """A scan (N, 3) [m, base frame], its guess T_map_base and regularization pose."""

    stamp_s: float
    points: ScanPoints
    guess: Pose
    regularization: Pose | None


Looked = tuple[Alignment, Verdict]


class Looks:
    """Looks at one scan after the other.

    :ivar second_looks: number of second looks so far.
    """

    def __init__(self, matcher: Matcher, judge: PoseJudge) -> None:
        self._matcher = matcher
        self._judge = judge
        self._vain = 0
        self.second_looks = 0

    def hope(self) -> None:
        """Try all again: a pose was believed, or another one is at hand."""
        self._vain = 0

    def look(self, scan: ScanAt, *, is_searching: bool) -> Looked:
        """Return the first result that is believed, else that of the guess.

        :param is_searching: a search looks farther.
        """
        first = self._from(scan, scan.guess)
        found: Looked | None = first if first[1].is_believed else None
        found = found or self._from_expectation(scan, first[1])
        may_try = not is_searching and self._vain < VAIN_SCANS
        if found is None and may_try:
            found = self._closer(scan, first) or self._second_look(scan, first)
        if self._is_doubtful(found or first) and (found is not None or may_try):
            found = self._around(scan, found or first) or found
        if found is None:
            self._vain += may_try
            return first
        return found

    def _is_doubtful(self, found: Looked) -> bool:
        """Return whether only foreign points would explain a first pose."""
        return found[1].expected is None and not found[0].fit > self._judge.level.of_first

    def _around(self, scan: ScanAt, best: Looked) -> Looked | None:
        """Return the best of a first pose and the places around the guess, if it is believed.

        What hides among foreign points at a wrong place fits at the right one. Where nothing
        constrains the position, as on a square, no place is better than another.
        """
        around = self._matcher.look_around(best[0], scan.points, scan.guess, scan.regularization)
        found = self._judged(scan, around)
        weak = found[1].weak
        is_place = weak is None or not weak.is_all
        return found if found[1].is_believed and is_place else None

    def _from_expectation(self, scan: ScanAt, before: Verdict) -> Looked | None:
        for start in _other_starts(scan.guess, before):
            found = self._from(scan, start)
            if found[1].is_believed:
                return found
        return None

    def _closer(self, scan: ScanAt, first: Looked) -> Looked | None:
        """Align to the finest level alone if the score refuses the pose or it is no maximum."""
        before, verdict = first
        if not (verdict.is_score_low or not before.converged):
            return None
        start = scan.guess if verdict.expected is None else verdict.expected.poses[0]
        for closer in self._matcher.closer_looks(scan.points, start, scan.regularization):
            found = self._judged(scan, closer)
            if found[1].is_believed:
                return found
        return None

    def _second_look(self, scan: ScanAt, first: Looked) -> Looked | None:
        if not self._judge.may_look_again(first[1]):
            return None
        alignment = self._matcher.second_look(
            first[0],
            scan.points,
            scan.guess,
            scan.regularization,
            convinces=lambda found: self._judged(scan, found)[1].is_believed,
        )
        self.second_looks += alignment.looks > first[0].looks
        found = self._judged(scan, alignment)
        return found if found[1].is_believed else None

    def _from(self, scan: ScanAt, start: Pose) -> Looked:
        found = self._matcher.align_once(scan.points, start, scan.regularization)
        return self._judged(scan, found)

    def _judged(self, scan: ScanAt, alignment: Alignment) -> Looked:
        """Judge an alignment; if nothing but its score refuses it, with what may explain that."""
        alignment = self._matcher.raised(alignment, scan.points)
        verdict = self._judge.judge(scan.stamp_s, alignment, scan.guess)
        if verdict.is_score_low and verdict.is_plausible:
            alignment = self._matcher.explained(alignment, scan.points)
            verdict = self._judge.judge(scan.stamp_s, alignment, scan.guess)
        return alignment, verdict


def _other_starts(guess: Pose, before: Verdict) -> Iterator[Pose]:
    """Yield where the motion leads, as far as that differs from the guess."""
    tried = [guess]
    for start in [] if before.expected is None else before.expected.poses:
        if not any(_is_near(start, other) for other in tried):
            tried.append(start)
            yield start


def _is_near(T: Pose, other: Pose) -> bool:
    return poses.distance_m(T, other) < OTHER_M and poses.angle_rad(T, other) < OTHER_RAD
