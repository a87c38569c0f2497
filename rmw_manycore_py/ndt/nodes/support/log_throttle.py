# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rate limit for repeated log messages."""

from __future__ import annotations

import re
from collections.abc import Callable

from rmw_manycore_py.process.steady import steady_s

REPEAT_S = 1.0
NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")  # messages that only differ in numbers count as equal


class LogThrottle:
    """Throttles each message separately; rclpy throttles per call site."""

    def __init__(self, repeat_s: float = REPEAT_S) -> None:
        self._repeat_s = repeat_s
        self._logged_s: dict[str, float] = {}  # last log time by message

    def is_due(self, message: str) -> bool:
        """Return whether a message may be logged again; if so, count it as logged."""
        now_s = steady_s()
        self._logged_s = {k: t for k, t in self._logged_s.items() if now_s - t < self._repeat_s}
        trouble = NUMBER.sub("", message)
        is_due = trouble not in self._logged_s
        self._logged_s.setdefault(trouble, now_s)
        return is_due


class ThrottledLog:
    """Logs each message at most once a second.

    :param log: log function of one severity: rclpy rejects different severities at one call site.
    """

    def __init__(self, log: Callable[[str], object]) -> None:
        self._log = log
        self._throttle = LogThrottle()

    def __call__(self, text: str) -> None:
        """Log the message, unless it was logged less than a second ago."""
        if self._throttle.is_due(text):
            self._log(text)
