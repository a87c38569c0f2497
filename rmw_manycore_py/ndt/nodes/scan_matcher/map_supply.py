# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sources of the map of `ndt_scan_matcher`.

In order of precedence: files around the vehicle (`map_path`), a map loader once it has answered, a
topic.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rclpy.node import Node

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps.map_area import MapArea
from rmw_manycore_py.ndt.maps.map_builder import MapBuilder
from rmw_manycore_py.ndt.maps.map_tiles import TileFiles, open_map
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap
from rmw_manycore_py.ndt.messages.point_cloud import decode
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.map_loader_client import MapLoaderClient
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters


class MapSupply:
    """Has maps built in the background and reports problems with them."""

    def __init__(
        self,
        node: Node,
        options: MatcherOptions,
        parameters: MatcherParameters,
        own: OwnParameters,
        admit: Callable[[VoxelMap], None],
        built: Callable[[], None],
    ) -> None:
        """Create the subscriptions and the builder.

        :param admit: accepts a map, or raises ManycoreError with the reason.
        :param built: called in any thread when there may be a map to take.
        """
        self._p = parameters
        self._admit = admit
        self._builder = MapBuilder(options, built, with_points=parameters.publish_loaded_map)
        self._area: MapArea | None = None
        self._loader: MapLoaderClient | None = None
        if own.map_path:
            tiles = open_map(Path(own.map_path).expanduser(), own.map_leaf_m)
            self._area = MapArea(tiles, parameters.map_radius_m, parameters.update_distance_m)
        else:
            self._loader = MapLoaderClient(
                node, parameters, self._builder.submit, lambda: self._builder.is_idle
            )
        self._vehicle: tuple[float, float] | None = None
        self._problem = ""
        self._warning = ""
        self.duration_ms = 0.0
        self.is_set = False

    def on_message(self, message: Any) -> None:
        """Use the newest map from the topic, until a map loader has answered."""
        if self._loader is not None and not self._loader.has_answered:
            self._builder.submit(partial(self._points_of, message))

    def _points_of(self, message: Any) -> Points:
        """Return the points of a map; raise an error if it is in another frame."""
        frame = message.header.frame_id
        if frame not in ("", self._p.map_frame):
            raise ManycoreError(
                f"pointcloud_map is in the frame '{frame}', expected '{self._p.map_frame}'"
            )
        return decode(message)

    def vehicle_is_at(self, x: float, y: float) -> None:
        """Load other tiles if the vehicle has moved far enough."""
        self._vehicle = (x, y)
        area = self._area
        if area is None or not self._builder.is_idle:
            return
        if area.is_due(x, y):
            # Other tiles than the first are read by the process that builds of them.
            update = area.update_files if self.is_set else area.update
            self._builder.submit(partial(update, x, y))

    def look_after_loader(self) -> None:
        """Query the map loader if the vehicle has moved far enough. Executor's thread."""
        if self._loader is None:
            return
        self._loader.forget_unanswered()
        place = self._vehicle
        if place is not None and self._centre_distance_m(*place) > self._p.update_distance_m:
            self._loader.ask(*place)

    async def update_around(self, x: float, y: float) -> None:
        """Request the map around a position and wait for the map loader's response.

        Executor's thread. The map has been built when `is_settled` returns True.
        """
        self.vehicle_is_at(x, y)
        call = self._loader.ask(x, y) if self._loader is not None else None
        if call is not None:
            await call

    @property
    def is_settled(self) -> bool:
        """Return whether no map is being built or waits to be taken."""
        return self._builder.is_idle

    def take(self) -> tuple[VoxelMap, Points | None] | None:
        """Return a map built since the last call, and its points if they are to be published."""
        # Before the builder is idle: the next update may be another thread's.
        asked = self._area.asked if self._area is not None else None
        built = self._builder.take()
        if built is None:
            return None
        if built.voxel_map is None:
            self._refuse(built.problem)
            return None
        try:
            self._admit(built.voxel_map)
        except ManycoreError as error:
            self._refuse(str(error))
            return None
        if self._area is not None:
            self._area.accept(asked)
        self._problem = ""
        self.is_set = True
        self._warning = built.warning
        self.duration_ms = built.duration_ms
        return built.voxel_map, built.points

    @property
    def loaded_files(self) -> TileFiles | None:
        """Files of the map in use; None if it comes from elsewhere, or is not set."""
        loaded = self._area.loaded if self._area is not None else None
        return loaded.files if loaded is not None else None

    def sample(self, files: TileFiles, max_count: int) -> Future[Points]:
        """Have at most `max_count` points (N, 3) of files read in the background."""
        return self._builder.sample(files, max_count)

    def _refuse(self, problem: str) -> None:
        """Keep the current map; without a problem the required tiles had not changed."""
        if not problem:
            return
        self._problem = problem
        if self._area is not None:
            self._area.refuse()
        if self._loader is not None:
            self._loader.forget_cells()

    def is_leaving(self, x: float, y: float) -> bool:
        """Return whether the LiDAR's range extends beyond the loaded area."""
        if not self._is_partial:
            return False
        return self._centre_distance_m(x, y) + self._p.lidar_radius_m > self._p.map_radius_m

    @property
    def _is_partial(self) -> bool:
        """Return whether the map only covers the area around the vehicle."""
        return self._area is not None or (self._loader is not None and self._loader.has_answered)

    def _centre_distance_m(self, x: float, y: float) -> float:
        """Return the distance to the centre of the loaded map; infinity before the first."""
        if self._area is not None:
            return self._area.distance_m(x, y)
        centre = self._loader.centre if self._loader is not None else None
        return float("inf") if centre is None else float(np.hypot(x - centre[0], y - centre[1]))

    def what_is_missing(self) -> str:
        """Return why there is no map."""
        if self._problem:
            return self._problem
        if self._area is not None:
            return "it is being loaded, or waits for a pose on ekf_pose_with_covariance"
        return (
            "run a map loader that serves pcd_loader_service, publish pointcloud_map, or set the "
            "parameter map_path"
        )

    def report(self, diagnostics: Diagnostics) -> None:
        """Add the state of the map to a report."""
        diagnostics.value("is_set_last_update_position", self._vehicle is not None)
        diagnostics.value("is_set_map_points", self.is_set)
        diagnostics.value("map_update_execution_time", round(self.duration_ms, 3))
        if self._problem:
            diagnostics.error(f"the map cannot be used: {self._problem}")
        if self._warning:
            diagnostics.warn(f"the map is coarse: {self._warning}")
        self.report_loader(diagnostics)
        if self._is_partial and self._vehicle is not None:
            distance_m = self._centre_distance_m(*self._vehicle)
            diagnostics.value("distance_last_update_position_to_current_position", distance_m)
            if self.is_set and self.is_leaving(*self._vehicle):
                diagnostics.error("Dynamic map loading is not keeping up.")

    def report_loader(self, diagnostics: Diagnostics) -> None:
        """Add the outcome of the last call of the map loader."""
        if self._loader is not None:
            self._loader.report(diagnostics)

    def close(self) -> None:
        """Stop building maps."""
        self._builder.close()
