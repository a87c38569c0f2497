# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Trace events of scan matching."""

from __future__ import annotations

import threading
from typing import Any

from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

from rmw_manycore_py.native import _transport
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.process.virtual_time import lives_in_virtual_time
from rmw_manycore_py.ros.domain import default_platform


class MatchingTrace:
    """Records alignments, passes of workers, and scans handed over to another thread.

    No-op unless the platform is traced, and with another RMW.
    """

    def __init__(self, node: Node, matcher: Matcher) -> None:
        self._matcher = matcher
        self._tracer: _transport.OwnTracer | None = None
        self._arrivals: dict[int, tuple[int, int]] = {}  # thread and time by message id
        if get_rmw_implementation_identifier() == "rmw_manycore":
            platform = default_platform(node.context.get_domain_id())
            self._tracer = _transport.OwnTracer(platform)
            matcher.on_aligned = self._aligned

    def arrived(self, message: Any) -> None:
        """Record the callback in which a scan arrived."""
        if self._tracer is not None and self._tracer.is_on:
            self._arrivals[id(message)] = (threading.get_native_id(), _transport.now_ns())

    def resume(self, message: Any) -> None:
        """Record that the calling thread continues with that scan."""
        arrival = self._arrivals.pop(id(message), None)
        if self._tracer is not None and arrival is not None:
            self._tracer.resume(*arrival)

    def skipped(self, message: Any) -> None:
        """Drop a scan that is not matched."""
        self._arrivals.pop(id(message), None)

    def _aligned(self, begin_ns: int) -> None:
        if self._tracer is None or not self._tracer.is_on or lives_in_virtual_time():
            return  # workers live in wall time
        self._tracer.align(begin_ns, _transport.now_ns())
        for worker, number, pass_begin_ns, pass_end_ns in self._matcher.passes():
            self._tracer.run_pass(pass_begin_ns, pass_end_ns, worker, number)
