# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recovery after refused scans: searches around the last good pose first, then farther.

For a first pose it searches with the first scan, globally: a search around the guess confirms that.

```
 tracking ── N scans refused ─► around: 5 m, 30 degrees ── unclear ─► globally: 20 m, any yaw
    ▲                              │ clear                               │ clear     │ unclear
    │                              ▼                                     ▼           ▼
    └──── a scan believed ◄─── found: scans are aligned from there ◄── the same around the guess,
                                                                       if it is elsewhere; again
```
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Pose, ScanPoints
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.trust.judge import PoseJudge
from rmw_manycore_py.ndt.trust.motion import Believed
from rmw_manycore_py.ndt.trust.region_search import RegionSearch
from rmw_manycore_py.ndt.trust.search import Found, Region

AROUND_M = 5.0
AT_ONCE = 2  # searches for a first pose that wait for no further refused scans


class Step(Enum):
    """State of a recovery."""

    TRACKING = "tracking"
    AROUND = "searching around the last good pose"
    GLOBALLY = "searching globally"
    FOUND = "found a pose"


@dataclass(frozen=True)
class _Scan:
    """A refused scan; `guess` is T_map_base, if there was one."""

    stamp_s: float
    points: ScanPoints
    guess: Pose | None


class Recovery:
    """Searches while scans are refused. Not thread-safe.

    :param after_scans: number of consecutive refused scans that starts a search; 0 disables it.
    :param radius_m: radius of the global search.
    """

    def __init__(self, options: MatcherOptions, after_scans: int, radius_m: float) -> None:
        self._after_scans = after_scans
        self._radius_m = radius_m
        self._search = RegionSearch(options)
        self._searched: _Scan | None = None
        self._region: Region | None = None
        self._is_first = False
        self._before: tuple[Found, _Scan] | None = None  # of the search before
        self._refused = 0
        self._searches = 0
        self.step = Step.TRACKING
        self.note = ""

    @property
    def is_on(self) -> bool:
        """Return whether the recovery is enabled."""
        return self._after_scans > 0

    def map_changed(self, voxel_map: VoxelMap) -> None:
        """Search in this map from now on."""
        self._search.map_changed(voxel_map)

    def hurry(self) -> None:
        """Start a search with the next refused scan."""
        self._refused = self._after_scans

    def believed(self) -> None:
        """Note that a scan was believed, which ends the recovery."""
        self._refused, self._searches, self.note = 0, 0, ""
        self._before = None
        self.step = Step.TRACKING

    def reset(self) -> None:
        """Reset; the result of a running search is discarded."""
        self.believed()
        self._searched = None

    def refused(
        self,
        stamp_s: float,
        points: ScanPoints,
        guess: Pose | None,
        at: Pose,
        *,
        is_first: bool = False,
    ) -> None:
        """Handle a refused scan; start a search when due.

        :param at: T_map_base to search around.
        :param is_first: no scan was believed before: the next may fare no better, and nothing says
            that the vehicle is near.
        """
        self._refused += 1
        is_due = self._refused >= self._after_scans or (is_first and self._searches < AT_ONCE)
        if not self.is_on or not is_due or not self._search.is_idle:
            return
        if self.step is Step.FOUND:
            self._searches, self._before = 0, None
        self._is_first = is_first
        self._region = self._next_region(at, guess, is_first)
        self.step = Step.GLOBALLY if self._region.any_yaw else Step.AROUND
        self._searches += 1
        self._refused = 0  # counts towards the next search
        self._searched = _Scan(stamp_s, points, guess)
        self._search.begin(points, self._region)

    def _next_region(self, at: Pose, guess: Pose | None, is_first: bool) -> Region:
        centres = [at]
        if guess is not None and poses.distance_m(at, guess) > self._radius_m:
            centres.append(guess)
        wide = [Region(centre, self._radius_m, any_yaw=True) for centre in centres]
        near = [Region(centre, AROUND_M, any_yaw=False) for centre in centres]
        pairs = zip(wide, near, strict=True) if is_first else zip(near, wide, strict=True)
        regions = [region for pair in pairs for region in pair]
        if self._searches < len(regions):
            return regions[self._searches]
        return wide[self._searches % len(wide)]

    def take(self, judge: PoseJudge) -> bool:
        """Make the judge continue from a pose found meanwhile; return whether it does."""
        try:
            found = self._search.take()
        except ManycoreError as error:
            self.note = str(error)
            return False
        if found is None:
            return False
        scan, self._searched = self._searched, None
        if scan is None or self.step is Step.TRACKING:  # recovered without it
            return False
        assert self._region is not None
        other = self._found_before(scan)
        unclear = found.why_unclear(judge.level, self._region, other, is_first=self._is_first)
        self._before = found, scan
        self.note = f"{self.step.value}: {unclear or 'clear'}"
        if unclear:
            return False
        best = found.places[0]
        self.step = Step.FOUND
        away_m = poses.distance_m(self._region.centre, best.T_map_sensor)
        self.note = (
            f"found a pose {away_m:.1f} m away, score {best.nearest_voxel_likelihood:.3f}, "
            f"{100 * found.margin:.0f} % before the next best"
        )
        judge.begin_at(Believed(scan.stamp_s, best.T_map_sensor, scan.guess))
        return True

    def _found_before(self, scan: _Scan) -> Found | None:
        """Return what the search before found, moved on like the guesses."""
        if self._before is None:
            return None
        found, then = self._before
        if scan.guess is None or then.guess is None:
            return found
        return found.moved(poses.inverse(then.guess) @ scan.guess)

    def close(self) -> None:
        """Stop the search."""
        self._search.close()
