# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`radius_search`: which voxels the points of a scan see; tiles of the map are swapped in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from manycore_ros_lite_msgs.msg import Pairs, Pool, Query
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.messages.conversions import nanoseconds
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.smem import SmemCharge
from rmw_manycore_py.papers.roslite.localization.swapping import Pooled, SwappedTiles
from rmw_manycore_py.papers.roslite.localization.tiles import Pairs as Found
from rmw_manycore_py.papers.roslite.localization.tiles import TileKey, joined, points_by_tile
from rmw_manycore_py.papers.roslite.messages import LATCHED, bytes_field, floats_field

KEPT_SCANS = 5


@dataclass(frozen=True)
class SearchParameters:
    """Parameters of the node: which share of a scan it searches, and its room for tiles."""

    part: int = parameter("part", 0, min_value=0)
    parts: int = parameter("parts", 1, min_value=1)
    smem_bytes: int = parameter("smem_bytes", 1 << 20, min_value=1)


class RadiusSearch(Node):
    """Publishes `ndt_found` for each `ndt_query` once it has the scan."""

    def __init__(self) -> None:
        super().__init__("radius_search")
        self._p = declare(self, SearchParameters)
        if self._p.part >= self._p.parts:
            expected = f"less than parts = {self._p.parts}"
            raise ManycoreError(
                f"parameter part: expected {expected}, found {self._p.part}", EXIT_BAD_INPUT
            )
        self._complain = ThrottledLog(self.get_logger().warning)
        self._charge = SmemCharge(self, "tiles of the map")
        self._tiles: SwappedTiles | None = None
        self._tile_m = 0.0
        # By stamp: newer ones come while the localizer still aligns one.
        self._scans: dict[int, NDArray[np.float32]] = {}
        self._waiting: Any = None  # a query that came before its scan
        self._output = self.create_publisher(Pairs, "ndt_found", 1)
        self.create_subscription(Pool, "ndt_pool", self._on_pool, LATCHED)
        self.create_subscription(PointCloud2, "filtered_points", self._on_scan, 1)
        self.create_subscription(Query, "ndt_query", self._on_query, 1)

    def _on_pool(self, message: Any) -> None:
        keys = map(TileKey, message.columns, message.rows)
        pool = dict(zip(keys, map(Pooled, message.paths, message.sizes), strict=True))
        self._tile_m = message.tile_m
        try:
            self._tiles = SwappedTiles(pool, self._p.smem_bytes, self._charge.hold)
        except ManycoreError as error:
            self._complain(f"ndt_pool ignored: {error}")

    def _on_scan(self, message: Any) -> None:
        try:
            scan = decode(message).astype(np.float32)
        except CloudError as error:
            self._complain(f"filtered_points ignored: {error}")
            return
        self._scans[nanoseconds(message.header.stamp)] = np.array_split(scan, self._p.parts)[
            self._p.part
        ]
        while len(self._scans) > KEPT_SCANS:
            del self._scans[next(iter(self._scans))]  # the oldest to arrive: stamps may jump back
        if self._waiting is not None:
            self._on_query(self._waiting)

    def _on_query(self, query: Any) -> None:
        scan = self._scans.get(nanoseconds(query.stamp))
        self._waiting = query if scan is None else None
        if self._tiles is None or scan is None:
            return
        try:
            counts, pairs = self._search(self._tiles, scan, np.asarray(query.pose).reshape(4, 4))
        except ManycoreError as error:
            self._complain(f"ndt_query not answered: {error}")
            return
        message = Pairs(stamp=query.stamp, pass_number=query.pass_number, part=self._p.part)
        message.counts, message.pairs = bytes_field(counts), floats_field(pairs)
        self._output.publish(message)

    def _search(self, tiles: SwappedTiles, scan: NDArray[np.float32], pose: Matrix) -> Found:
        parts = points_by_tile(scan, pose, self._tile_m)
        return joined(_ndt.search_pairs(tile, parts[key], pose) for key, tile in tiles.visit(parts))


def main() -> None:
    """Run the node until interrupted."""
    run_node(RadiusSearch)


if __name__ == "__main__":
    main()
