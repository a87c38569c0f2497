# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes /clock for a player: the position in the recording, for use_sim_time."""

from __future__ import annotations

import struct
import threading

from rmw_manycore_bridge.outside import types
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.play.position import Position
from rmw_manycore_py.recording.play.program import CLOCK_TOPIC
from rmw_manycore_py.recording.play.stage import RawPublisher, Stage

_TYPE = "rosgraph_msgs/msg/Clock"
_NS_PER_S = 1_000_000_000
_MAX_SECONDS = 2**31 - 1  # of builtin_interfaces/msg/Time, which ends in 2038


class Clock:
    """Publishes in its own thread, also while paused."""

    def __init__(self, stage: Stage, position: Position, rate_hz: float) -> None:
        self._position, self._period_s = position, 1 / rate_hz
        self._publisher: RawPublisher = stage.publisher(
            CLOCK_TOPIC, _TYPE, types.hash_of(_TYPE), Qos(depth=1)
        )
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="clock")

    def start(self) -> None:
        """Start publishing."""
        self._thread.start()

    def _run(self) -> None:
        self.tell()
        while not self._over.wait(self._period_s):
            self.tell()

    def tell(self) -> None:
        """Publish the time."""
        self._publisher.publish(clock_message(self._position.at_ns()))

    def stop(self) -> None:
        """Stop the thread."""
        self._over.set()
        self._thread.join()


def clock_message(time_ns: int) -> bytes:
    """Return a serialized rosgraph_msgs/msg/Clock; later times become the last that it holds."""
    seconds, rest = divmod(time_ns, _NS_PER_S)
    if seconds > _MAX_SECONDS:
        seconds, rest = _MAX_SECONDS, _NS_PER_S - 1
    return struct.pack("<BBHiI", 0, 1, 0, seconds, rest)
