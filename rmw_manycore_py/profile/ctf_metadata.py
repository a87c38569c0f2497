# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks of the metadata of LTTng traces that babeltrace2 does not make."""

from __future__ import annotations

import re
import struct
from pathlib import Path

from rmw_manycore_py.errors import FileError, Problem

_MAGIC = 0x75D11D57
# Of CTF 1.8: magic, UUID, checksum, content size and packet size in bits; five more bytes follow.
_HEADER = "I16x4xII"
_HEADER_BYTES = 37
# In the first packet, since LTTng begins with it.
_SESSION = re.compile(rb'\b(hostname|trace_name|trace_creation_datetime) = "([^"]*)"')


def check_metadata(directory: Path) -> None:
    """Check that a directory holds the traces of one session, with their whole metadata.

    :raises FileError: if not. babeltrace2 would never end, or merge unrelated processes.
    """
    sessions: dict[frozenset[tuple[bytes, bytes]], Path] = {}
    for path in sorted(directory.rglob("metadata")):
        content = path.read_bytes()
        _check_whole(path, content)
        sessions.setdefault(frozenset(_SESSION.findall(content)), path.parent)
    if len(sessions) > 1:
        found = " and ".join(str(path.relative_to(directory)) for path in sessions.values())
        expected = "the trace of one session (import each by itself)"
        raise FileError(Problem(directory, 0, "", expected, found))


def _check_whole(path: Path, content: bytes) -> None:
    """Check that no packet is cut off; metadata without packets are text."""
    orders = [order for order in "<>" if content[:4] == struct.pack(f"{order}I", _MAGIC)]
    offset = 0
    while orders and offset < len(content):
        packet_bytes = 0
        if offset + _HEADER_BYTES <= len(content):
            magic, _, packet_bits = struct.unpack_from(orders[0] + _HEADER, content, offset)
            packet_bytes = packet_bits // 8 if magic == _MAGIC else 0
        if packet_bytes < _HEADER_BYTES or offset + packet_bytes > len(content):
            expected = "whole packets (copy the trace again)"
            raise FileError(Problem(path, 0, "", expected, f"a part at byte {offset}"))
        offset += packet_bytes
