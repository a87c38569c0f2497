# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Output of a command node per message: its path, and statistics of all so far."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from rmw_manycore_py.papers.reference_system.sample import name_of, records_of
from rmw_manycore_py.papers.reference_system.statistics import Statistic

HOT_PATH_ROOTS = ("FrontLidarDriver", "RearLidarDriver")
HOT_PATH_SINK = "ObjectCollisionEstimator"
HOT_PATH = (
    *HOT_PATH_ROOTS,
    *("PointsTransformerFront", "PointsTransformerRear", "PointCloudFusion"),
    *("RayGroundFilter", "EuclideanClusterDetector", HOT_PATH_SINK),
)
PLANNER = "BehaviorPlanner"
# The first messages are excluded, since nodes are still starting.
UNCOUNTED = 9
NS_PER_MS = 1e6
RULE = "-" * 58
HEADING = "  order timepoint           sequence nr.                  node name     dropped samples"


class SamplePath:
    """Statistics of the messages received by one command node."""

    def __init__(self, node_name: str) -> None:
        self._node_name = node_name
        self._messages = 0
        self._latency = Statistic("ms")
        self._hot_path_latency = Statistic("ms")
        self._hot_path_drops = Statistic()
        self._period = Statistic("ms")
        self._planner: tuple[int, int] | None = None  # last timestamp and sequence number
        self._dropped: dict[str, Statistic] = defaultdict(Statistic)

    def add(self, message: Any, timestamp_ns: int, missed: int) -> list[str]:
        """Add a message; return the lines to print."""
        records = {name_of(record): record for record in records_of(message)}
        self._messages += 1
        lines = [RULE, f"sample path: ({self._node_name})", *self._table(records)]
        lines.append(self._row(len(records), timestamp_ns, "endpoint", self._node_name, missed))
        if self._messages > UNCOUNTED and records:
            lines += ["", "Statistics:", *self._statistics(records, timestamp_ns)]
        return [*lines, RULE, ""]

    def _table(self, records: Mapping[str, Any]) -> list[str]:
        order = {stamp: i for i, stamp in enumerate(sorted(r.timestamp for r in records.values()))}
        return [
            HEADING,
            *(
                self._row(
                    order[r.timestamp], r.timestamp, r.sequence_number, name, r.dropped_samples
                )
                for name, r in records.items()
            ),
        ]

    def _row(self, order: int, stamp_ns: int, number: int | str, name: str, dropped: int) -> str:
        self._dropped[name].add(dropped)
        return f"  [{order:2}]  {stamp_ns}  {number:>10}    {name:>24}     {self._dropped[name]}"

    def _statistics(self, records: Mapping[str, Any], timestamp_ns: int) -> list[str]:
        oldest_ns = min(record.timestamp for record in records.values())
        self._latency.add((timestamp_ns - oldest_ns) / NS_PER_MS)
        lines = [f"  latency:                  {self._latency}"]
        if HOT_PATH_SINK in records:
            lines += self._hot_path(records)
        if PLANNER in records:
            self._add_period(records[PLANNER])
            if self._period.count:
                lines.append(f"  behavior planner period:  {self._period}")
        return lines

    def _hot_path(self, records: Mapping[str, Any]) -> list[str]:
        started_ns = max(records[root].timestamp for root in HOT_PATH_ROOTS if root in records)
        self._hot_path_latency.add((records[HOT_PATH_SINK].timestamp - started_ns) / NS_PER_MS)
        self._hot_path_drops.add(sum(records[n].dropped_samples for n in HOT_PATH if n in records))
        return [
            f"  hot path:                 {'/'.join(HOT_PATH_ROOTS)} -> {HOT_PATH_SINK}",
            f"  hot path latency:         {self._hot_path_latency}",
            f"  hot path drops:           {self._hot_path_drops}",
        ]

    def _add_period(self, record: Any) -> None:
        now = (record.timestamp, record.sequence_number)
        if self._planner is not None and now[1] > self._planner[1]:
            (before_ns, before) = self._planner
            self._period.add((now[0] - before_ns) / (now[1] - before) / NS_PER_MS)
        self._planner = now
