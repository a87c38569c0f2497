# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Asks a map loader for the map around the vehicle: `pcd_loader_service`, as Autoware's node."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

from autoware_map_msgs.msg import AreaInfo
from autoware_map_msgs.srv import GetDifferentialPointCloudMap
from rclpy.node import Node
from rclpy.task import Future

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.map_cells import MapCells
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters

ANSWER_TIMEOUT_S = 30.0  # reading hundreds of megabytes of cells from a slow disk

Read = Callable[[], Points]


class MapLoaderClient:
    """Knows which cells are there, and asks for the others; one call at a time.

    All methods belong to the executor's thread. Cells are taken out of an answer where `submit`
    has that done; until `is_idle` holds again nothing is asked.

    :param submit: has a map built of the points that its argument returns.
    :param is_idle: tells whether nothing that was submitted is still to be done.
    """

    def __init__(
        self,
        node: Node,
        parameters: MatcherParameters,
        submit: Callable[[Read], None],
        is_idle: Callable[[], bool],
    ) -> None:
        self._node = node
        self._radius_m = parameters.map_radius_m
        self._submit = submit
        self._is_idle = is_idle
        self._cells = MapCells(parameters.map_frame)
        self._client = node.create_client(GetDifferentialPointCloudMap, "pcd_loader_service")
        self._call: Future | None = None
        self._handled = Future()  # done when the call has its answer, or is forgotten
        self._asked_s = 0.0
        self._last: dict[str, object] = {}  # what the diagnostics say of the last call
        self.centre: tuple[float, float] | None = None  # of what was loaded last
        self.has_answered = False

    def ask(self, x: float, y: float) -> Future | None:
        """Ask for the cells around a place; return what is done once the answer was taken.

        None where that has to wait, or no map loader is there.
        """
        if self._call is not None or not self._is_idle() or not self._client.service_is_ready():
            return None
        request = GetDifferentialPointCloudMap.Request()
        request.area = AreaInfo(center_x=x, center_y=y, radius=self._radius_m)
        request.cached_ids = self._cells.ids
        count = len(request.cached_ids)
        self._last = {"is_need_rebuild": count == 0, "maps_size_before": count}
        self._asked_s = time.monotonic()
        call = self._client.call_async(request)
        self._call, self._handled = call, Future()
        call.add_done_callback(partial(self._on_answer, (x, y)))
        return self._handled

    def forget_unanswered(self) -> None:
        """Let the next call be made where the last one is not answered any more."""
        if self._call is None:
            return
        is_late = time.monotonic() - self._asked_s > ANSWER_TIMEOUT_S
        if self._client.service_is_ready() and not is_late:
            return
        call, self._call = self._call, None
        self._client.remove_pending_request(call)
        call.cancel()
        self._handled.set_result(None)
        self._last["is_succeed_call_pcd_loader"] = False
        self._node.get_logger().warning("pcd_loader_service does not answer: is it running?")

    def forget_cells(self) -> None:
        """Ask for all cells next time: those that are there cannot be used."""
        self._cells.clear()
        self.centre = None

    def report(self, diagnostics: Diagnostics) -> None:
        """Add what became of the last call."""
        for key, value in self._last.items():
            diagnostics.value(key, value)

    def _on_answer(self, centre: tuple[float, float], call: Future) -> None:
        response = call.result()
        if self._call is not call or response is None:  # forgotten meanwhile
            return
        self._call = None
        self.has_answered = True
        self.centre = centre
        added, removed = len(response.new_pointcloud_with_ids), len(response.ids_to_remove)
        self._last |= {
            "is_succeed_call_pcd_loader": True,
            "maps_to_add_size": added,
            "maps_to_remove_size": removed,
            "maps_size_after": len(self._cells.ids) + added - removed,
            "is_updated_map": bool(added or removed),
        }
        if added or removed:
            self._submit(partial(self._cells.apply, response))
        self._handled.set_result(None)
