# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Decides which commands reach the vehicle. Source: vehicle_cmd_gate of Autoware Universe.

```
  heartbeat late ──► STOPPED ──clear, heartbeat back──► PASSING
  stop requested ──►    │                                  │
                emergency command, 10 Hz     command of the source, as it comes;
                                             speed 0 while not engaged
```
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Source(Enum):
    """Source of a command."""

    AUTO = "auto"
    EXTERNAL = "external"
    EMERGENCY = "emergency"


class Passage(Enum):
    """What happens to a received command."""

    BLOCKED = "blocked"
    HELD = "held"  # passes with its steering and zero speed
    PASSED = "passed"


@dataclass(frozen=True)
class GateOptions:
    """Monitored heartbeats and their timeouts; 0 s disables a timeout.

    :param watches_external: no command passes before the first external heartbeat.
    :param watches_system: the same for the state of the emergency handler.
    """

    watches_external: bool = True
    watches_system: bool = False
    external_timeout_s: float = 0.5
    system_timeout_s: float = 0.5


@dataclass
class Gate:
    """State of the gate; times in seconds of one clock."""

    options: GateOptions
    source: Source = Source.AUTO
    is_engaged: bool = False
    is_stopped: bool = False  # latched until `clear`
    is_system_emergency: bool = False
    is_external_late: bool = False
    is_system_late: bool = False
    _external_s: float | None = None
    _system_s: float | None = None

    def external_heartbeat(self, now_s: float) -> None:
        """Record a heartbeat of the external controller."""
        self._external_s = now_s

    def system_state(self, now_s: float, is_emergency: bool) -> None:
        """Record the state of the emergency handler, which also counts as its heartbeat."""
        self._system_s, self.is_system_emergency = now_s, is_emergency

    def missing(self) -> tuple[str, ...]:
        """Return the required heartbeats that have never arrived."""
        watched = (
            ("emergency state", self.options.watches_system, self._system_s),
            ("external heartbeat", self.options.watches_external, self._external_s),
        )
        return tuple(name for name, is_watched, seen_s in watched if is_watched and seen_s is None)

    def tick(self, now_s: float) -> bool:
        """Check the heartbeats; return whether the emergency command replaces others."""
        if self.missing():
            return False
        if self.options.watches_system:
            self.is_system_late = _is_late(self._system_s, self.options.system_timeout_s, now_s)
        if self.options.watches_external:
            timeout_s = self.options.external_timeout_s
            self.is_external_late = _is_late(self._external_s, timeout_s, now_s)
            self.is_stopped = self.is_stopped or self.is_external_late
        return self.is_system_late or self.is_stopped

    def passage(self, source: Source) -> Passage:
        """Return what happens to a received command."""
        if self.missing() or self.is_system_late or self.is_stopped:
            return Passage.BLOCKED
        if source is not self.wanted_source():
            return Passage.BLOCKED
        return Passage.PASSED if self.is_engaged else Passage.HELD

    def wanted_source(self) -> Source:
        """Return the source whose commands pass."""
        is_emergency = self.options.watches_system and self.is_system_emergency
        return Source.EMERGENCY if is_emergency else self.source

    def stop(self) -> None:
        """Stop until `clear`."""
        self.is_stopped = True

    def clear(self) -> bool:
        """Release a stop; return False if the heartbeat is late or nothing is stopped."""
        was_stopped = self.is_stopped
        if was_stopped and not self.is_external_late:
            self.is_stopped = False
        return was_stopped and not self.is_stopped


def _is_late(seen_s: float | None, timeout_s: float, now_s: float) -> bool:
    return timeout_s > 0.0 and (seen_s is None or now_s - seen_s > timeout_s)
