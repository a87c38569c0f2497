# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Protocol between a supervisor and its clients: one JSON object per line."""

from __future__ import annotations

import json
from typing import Any

from rmw_manycore_py.errors import ManycoreError

# Room for the names of 1024 nodes; terminal input comes in far smaller pieces.
MAX_LINE_BYTES = 1 << 20
Message = dict[str, Any]


class LineBuffer:
    """Splits received bytes into messages."""

    def __init__(self) -> None:
        self._rest = bytearray()

    def take(self, data: bytes) -> list[Message]:
        """Return the complete messages received so far.

        :raises ManycoreError: if the input is not JSON objects.
        """
        self._rest += data  # in place: a slow writer must not cost a copy for each byte
        lines = []
        if b"\n" in data:
            *lines, self._rest = self._rest.split(b"\n")
        if any(len(line) > MAX_LINE_BYTES for line in (*lines, self._rest)):
            raise ManycoreError(f"control message longer than {MAX_LINE_BYTES} bytes")
        return [_message(line) for line in lines]


def encoded(message: Message) -> bytes:
    """Encode a message for the socket."""
    return json.dumps(message).encode() + b"\n"


def _message(line: bytearray) -> Message:
    try:
        message = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise ManycoreError("control message is not JSON, or is nested too deeply") from error
    if not isinstance(message, dict):
        raise ManycoreError("control message is not a JSON object")
    return message
