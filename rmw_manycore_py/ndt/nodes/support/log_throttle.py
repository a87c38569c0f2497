# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How often a trouble that lasts is logged."""

from __future__ import annotations

import re
import time
from collections.abc import Callable

REPEAT_S = 1.0
NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")  # troubles that differ in numbers alone are the same


class LogThrottle:
    """Throttles each trouble by itself; others do not hide it, as rclpy's throttling would."""

    def __init__(self, repeat_s: float = REPEAT_S) -> None:
        self._repeat_s = repeat_s
        self._logged_s: dict[str, float] = {}  # when each trouble was logged last

    def is_due(self, message: str) -> bool:
        """Tell whether a trouble may be logged again, and count it as logged then."""
        now_s = time.monotonic()
        self._logged_s = {k: t for k, t in self._logged_s.items() if now_s - t < self._repeat_s}
        trouble = NUMBER.sub("", message)
        is_due = trouble not in self._logged_s
        self._logged_s.setdefault(trouble, now_s)
        return is_due


class ThrottledLog:
    """Logs each trouble at most once a second.

    :param log: of a node's logger, and of one severity: rclpy refuses another one from here.
    """

    def __init__(self, log: Callable[[str], object]) -> None:
        self._log = log
        self._throttle = LogThrottle()

    def __call__(self, text: str) -> None:
        """Log it, unless the same trouble was logged just now."""
        if self._throttle.is_due(text):
            self._log(text)
