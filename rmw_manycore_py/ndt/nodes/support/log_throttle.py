# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How often a trouble that lasts is logged."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node

REPEAT_S = 1.0
NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")  # troubles that differ in numbers alone are the same


class LogThrottle:
    """Throttles each trouble by itself; others do not hide it, as rclpy's throttling would."""

    def __init__(self) -> None:
        self._logged_s: dict[str, float] = {}  # when each trouble was logged last

    def is_due(self, message: str) -> bool:
        """Tell whether a trouble may be logged again, and count it as logged then."""
        now_s = time.monotonic()
        self._logged_s = {k: t for k, t in self._logged_s.items() if now_s - t < REPEAT_S}
        trouble = NUMBER.sub("", message)
        is_due = trouble not in self._logged_s
        self._logged_s.setdefault(trouble, now_s)
        return is_due


class ThrottledWarnings:
    """The warnings of a node, each trouble at most once a second."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._throttle = LogThrottle()

    def log(self, text: str) -> None:
        """Log a warning, unless the same trouble was logged just now."""
        if self._throttle.is_due(text):
            self._node.get_logger().warning(text)
