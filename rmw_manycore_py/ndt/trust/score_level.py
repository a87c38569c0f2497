# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Minimum score of a believed pose, from the map's own score and the drive's.

Scores are nearest-voxel likelihoods. The score of a right pose differs between maps and sensors by
tens of per cent, but along one drive by a few. So the drive's scores give a tight level once there
are some; the map's give one that holds from the start and cannot be lowered by a drive.
"""

from __future__ import annotations

from collections import deque
from statistics import median

from rmw_manycore_py.ndt.matching.second_look import CONVINCING_SHARE

# Determined by `manycore bench ndt`, leaving out each recording in turn; see
# docs/reference/benchmarks/scan_matching.md.
MAP_SHARE = 0.75  # of the score of the map's own points
DRIVE_SHARE = 0.90  # of the median of recent believed scores
CONFIRMED_SHARE = 0.95  # of a first pose's explained score: where motion or searches lead alike

FEWEST_SCORES = 5  # minimum number for the drive's median
KEPT_SCORES = 20  # 2 s at 10 Hz: follows the place, not single scans


class ScoreLevel:
    """Learns from the scores of believed poses.

    A series of wrong poses cannot lower the level: they are not believed, and nothing below
    `map_share` of the map's own score ever is.
    """

    def __init__(
        self,
        map_share: float = MAP_SHARE,
        drive_share: float = DRIVE_SHARE,
        first_share: float = CONVINCING_SHARE,
        explained_share: float = CONVINCING_SHARE,
    ) -> None:
        self._map_share = map_share
        self._drive_share = drive_share
        self._first_share = first_share
        self._explained_share = explained_share
        self._map_score = 0.0
        self._scores: deque[float] = deque(maxlen=KEPT_SCORES)

    def map_changed(self, own_score: float) -> None:
        """Set the score of a new map's own points.

        The scores of the drive are kept, in proportion.
        """
        if self._map_score > 0.0 and own_score > 0.0:
            scale = own_score / self._map_score
            self._scores = deque((score * scale for score in self._scores), maxlen=KEPT_SCORES)
        self._map_score = own_score

    def learn(self, score: float) -> None:
        """Add the score of a pose that is believed for reasons beyond its score."""
        self._scores.append(score)

    def forget(self) -> None:
        """Reset to the map's score only: another place, or another drive."""
        self._scores.clear()

    @property
    def of_map(self) -> float:
        """Return the level required by the map alone."""
        return self._map_share * self._map_score

    @property
    def of_first(self) -> float:
        """Return the minimum fit of a first pose without a search."""
        return self._first_share * self._map_score

    @property
    def of_explained(self) -> float:
        """Return the minimum explained score of a first pose."""
        usual = self._map_score if len(self._scores) < FEWEST_SCORES else median(self._scores)
        return max(self.of_map, self._explained_share * usual)

    @property
    def of_confirmed(self) -> float:
        """Return the minimum explained score of a pose that something else leads to as well."""
        return max(self.of_map, CONFIRMED_SHARE * self.of_explained)

    @property
    def level(self) -> float:
        """Return the minimum score of a pose."""
        if len(self._scores) < FEWEST_SCORES:
            return self.of_map
        return max(self.of_map, self._drive_share * median(self._scores))
