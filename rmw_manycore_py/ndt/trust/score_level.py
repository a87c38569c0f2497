# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The score below which a pose is not believed: from the map's own score, and from the drive's.

Scores are nearest-voxel likelihoods. What a right pose scores differs between maps and sensors by
tens of per cent, and along one drive by a few. So the drive's own scores make a close level, once
there are some; the map's make one that holds from the start and that no drive can lower.
"""

from __future__ import annotations

from collections import deque
from statistics import median

# `manycore bench ndt` chooses both anew, leaving each recording out in turn (docs/benchmarks.md).
MAP_SHARE = 0.75  # of the score that the map's own points have
DRIVE_SHARE = 0.90  # of the median of the last believed scores
FIRST_SHARE = 0.90  # of the map's own score: the fit of a pose that no motion confirms

FEWEST_SCORES = 5  # that tell the drive's median
KEPT_SCORES = 20  # 2 s at 10 Hz: a level that follows the place, not a single scan


class ScoreLevel:
    """Learns from the scores of poses that are believed.

    A run of wrong poses cannot lower the level: they are not believed, and below `map_share` of the
    map's own score nothing ever is.
    """

    def __init__(
        self,
        map_share: float = MAP_SHARE,
        drive_share: float = DRIVE_SHARE,
        first_share: float = FIRST_SHARE,
    ) -> None:
        self._map_share = map_share
        self._drive_share = drive_share
        self._first_share = first_share
        self._map_score = 0.0
        self._scores: deque[float] = deque(maxlen=KEPT_SCORES)

    def map_changed(self, own_score: float) -> None:
        """Take the score that the points of a new map have in it.

        What the drive has taught holds on, in proportion.
        """
        if self._map_score > 0.0 and own_score > 0.0:
            scale = own_score / self._map_score
            self._scores = deque((score * scale for score in self._scores), maxlen=KEPT_SCORES)
        self._map_score = own_score

    def learn(self, score: float) -> None:
        """Take the score of a pose that is believed for more than its score."""
        self._scores.append(score)

    def forget(self) -> None:
        """Begin anew, from the map's score alone: another place, or another drive."""
        self._scores.clear()

    @property
    def of_map(self) -> float:
        """Return the level that the map alone demands."""
        return self._map_share * self._map_score

    @property
    def of_first(self) -> float:
        """Return the fit that a first pose needs to be believed without a search."""
        return self._first_share * self._map_score

    @property
    def level(self) -> float:
        """Return the score that a pose must reach."""
        if len(self._scores) < FEWEST_SCORES:
            return self.of_map
        return max(self.of_map, self._drive_share * median(self._scores))
