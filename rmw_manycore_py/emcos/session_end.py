# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What both ends of a session have in common: the size of the buffers, and the limit of eight."""

from __future__ import annotations

import weakref

from rmw_manycore_py.emcos.end import End
from rmw_manycore_py.transport.arguments import Deadline, checked_number
from rmw_manycore_py.transport.errors import TransportError

# As many as a NoC interface of the MPPA has UC.
MAX_SESSIONS = 8
MAX_SIZE_BYTES = 1 << 46  # of an address space

_sessions: weakref.WeakSet[SessionEnd] = weakref.WeakSet()


class SessionEnd(End):
    """One end of a session.

    :ivar size_bytes: size of the buffer at each end.
    """

    def __init__(
        self, name: str, size_bytes: int, platform: str | None, deadline: Deadline
    ) -> None:
        self.size_bytes = checked_number("size_bytes", size_bytes, 1, MAX_SIZE_BYTES)
        self._require_a_free_one(name)
        super().__init__(name, platform, deadline, size_bytes)
        _sessions.add(self)

    def _require_a_free_one(self, name: str) -> None:
        """Raise a TransportError if this process has eight sessions in this direction."""
        others = [s for s in _sessions if type(s) is type(self) and s._link.is_open]
        if len(others) >= MAX_SESSIONS:
            names = ", ".join(sorted(session.name for session in others))
            raise TransportError(
                f"{type(self).__name__} '{name}': a process has at most {MAX_SESSIONS} sessions "
                f"each way, and has {names}; close one, or use messages or segments"
            )
