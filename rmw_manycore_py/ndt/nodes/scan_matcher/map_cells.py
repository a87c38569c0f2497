# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Map cells received from a map loader, by id."""

from __future__ import annotations

from typing import Any

import numpy as np

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode


class MapCells:
    """Applies the responses of `GetDifferentialPointCloudMap`, one at a time."""

    def __init__(self, map_frame: str) -> None:
        self._map_frame = map_frame
        self._points: dict[str, Points] = {}

    @property
    def ids(self) -> list[str]:
        """Return the ids of the held cells."""
        return list(self._points)

    def clear(self) -> None:
        """Drop all cells, so that the next response contains all required ones."""
        self._points = {}

    def apply(self, response: Any) -> Points:
        """Add and remove cells according to a response; return the points (N, 3) of all cells.

        :raises ManycoreError: if the response is unusable; all cells are dropped then.
        """
        try:
            self._points = self._changed(response)
        except ManycoreError:
            self.clear()
            raise
        clouds = list(self._points.values())
        return np.concatenate(clouds) if clouds else np.zeros((0, 3), np.float32)

    def _changed(self, response: Any) -> dict[str, Points]:
        frame = response.header.frame_id
        if frame not in ("", self._map_frame):
            raise ManycoreError(
                f"pcd_loader_service: the cells are in the frame '{frame}', expected "
                f"'{self._map_frame}'"
            )
        removed = set(response.ids_to_remove)
        kept = {name: points for name, points in self._points.items() if name not in removed}
        for cell in response.new_pointcloud_with_ids:
            try:
                kept[cell.cell_id] = decode(cell.pointcloud)
            except CloudError as error:
                raise ManycoreError(f"pcd_loader_service: cell {cell.cell_id}: {error}") from error
        return kept
