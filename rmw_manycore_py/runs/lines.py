# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a supervisor and its clients say to each other: JSON objects, one a line."""

from __future__ import annotations

import json
from typing import Any

from rmw_manycore_py.errors import ManycoreError

# Names of up to 1024 nodes; a terminal's input comes in far smaller pieces.
MAX_LINE_BYTES = 1 << 20
Message = dict[str, Any]


class LineBuffer:
    """Cuts what a socket brings into messages."""

    def __init__(self) -> None:
        self._rest = b""

    def take(self, data: bytes) -> list[Message]:
        """Return the messages that are complete by now.

        :raises ManycoreError: when the other side says something else than JSON objects.
        """
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > MAX_LINE_BYTES:
            raise ManycoreError("a message of a run is too long")
        return [_message(line) for line in lines]


def encoded(message: Message) -> bytes:
    """Return a message as it goes through the socket."""
    return json.dumps(message).encode() + b"\n"


def _message(line: bytes) -> Message:
    try:
        message = json.loads(line)
    except ValueError as error:
        raise ManycoreError("a message of a run is no JSON") from error
    if not isinstance(message, dict):
        raise ManycoreError("a message of a run is no JSON object")
    return message
