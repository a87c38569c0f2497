# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What traces of the platform show of scan matching."""

from __future__ import annotations

import threading
import time
from typing import Any

from rclpy.node import Node
from rclpy.utilities import get_rmw_implementation_identifier

from rmw_manycore_py import _transport
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ros.domain import default_platform


class MatchingTrace:
    """Notes alignments, passes of workers, and scans that another thread goes on with.

    Only while the platform is traced; with another RMW there is nothing to note for.
    """

    def __init__(self, node: Node, matcher: Matcher) -> None:
        self._matcher = matcher
        self._tracer: _transport.OwnTracer | None = None
        self._arrivals: dict[int, tuple[int, int]] = {}  # by message: thread and time
        if get_rmw_implementation_identifier() == "rmw_manycore":
            platform = default_platform(node.context.get_domain_id())
            self._tracer = _transport.OwnTracer(platform)
            matcher.on_aligned = self._aligned

    def arrived(self, message: Any) -> None:
        """Remember the callback that a scan arrived in."""
        if self._tracer is not None and self._tracer.is_on:
            self._arrivals[id(message)] = (threading.get_native_id(), time.monotonic_ns())

    def resume(self, message: Any) -> None:
        """Note that the calling thread goes on with that scan."""
        arrival = self._arrivals.pop(id(message), None)
        if self._tracer is not None and arrival is not None:
            self._tracer.resume(*arrival)

    def skipped(self, message: Any) -> None:
        """Forget a scan that is not matched."""
        self._arrivals.pop(id(message), None)

    def _aligned(self, begin_ns: int) -> None:
        if self._tracer is None or not self._tracer.is_on:
            return
        self._tracer.align(begin_ns, time.monotonic_ns())
        for worker, number, pass_begin_ns, pass_end_ns in self._matcher.passes():
            self._tracer.run_pass(pass_begin_ns, pass_end_ns, worker, number)
