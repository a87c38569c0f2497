# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests the map around the vehicle from `pcd_loader_service`, as Autoware's node does."""

from __future__ import annotations

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
from rmw_manycore_py.process.steady import steady_s

ANSWER_TIMEOUT_S = 30.0  # reading hundreds of megabytes of cells from a slow disk

Read = Callable[[], Points]


class MapLoaderClient:
    """Tracks the held cells and requests missing ones; one call at a time.

    All methods belong to the executor's thread. Cells are extracted from a response where `submit`
    runs its argument; no request is sent until `is_idle` returns True again.

    :param submit: builds a map of the points returned by its argument.
    :param is_idle: returns whether all submitted work is done.
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
        self._handled = Future()  # done when the call is answered or given up
        self._asked_s = 0.0
        self._last: dict[str, object] = {}  # diagnostics of the last call
        self.centre: tuple[float, float] | None = None  # centre of the area loaded last
        self.has_answered = False

    def ask(self, x: float, y: float) -> Future | None:
        """Request the cells around a position; return a Future done when the response is handled.

        None if a call is pending or there is no map loader.
        """
        if self._call is not None or not self._is_idle() or not self._client.service_is_ready():
            return None
        request = GetDifferentialPointCloudMap.Request()
        request.area = AreaInfo(center_x=x, center_y=y, radius=self._radius_m)
        request.cached_ids = self._cells.ids
        count = len(request.cached_ids)
        self._last = {"is_need_rebuild": count == 0, "maps_size_before": count}
        self._asked_s = steady_s()
        call = self._client.call_async(request)
        self._call, self._handled = call, Future()
        call.add_done_callback(partial(self._on_answer, (x, y)))
        return self._handled

    def forget_unanswered(self) -> None:
        """Give up a call that is no longer answered, so that the next one can be made."""
        if self._call is None:
            return
        is_late = steady_s() - self._asked_s > ANSWER_TIMEOUT_S
        if self._client.service_is_ready() and not is_late:
            return
        call, self._call = self._call, None
        self._client.remove_pending_request(call)
        call.cancel()
        self._handled.set_result(None)
        self._last["is_succeed_call_pcd_loader"] = False
        self._node.get_logger().warning("pcd_loader_service does not answer: is it running?")

    def forget_cells(self) -> None:
        """Request all cells next time: the held ones are unusable."""
        self._cells.clear()
        self.centre = None

    def report(self, diagnostics: Diagnostics) -> None:
        """Add the outcome of the last call."""
        for key, value in self._last.items():
            diagnostics.value(key, value)

    def _on_answer(self, centre: tuple[float, float], call: Future) -> None:
        response = call.result()
        if self._call is not call or response is None:  # given up meanwhile
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
