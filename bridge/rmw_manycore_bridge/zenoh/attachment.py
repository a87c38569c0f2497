# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Attachment of rmw_zenoh to each message, request and response: 33 bytes."""

from __future__ import annotations

import struct
from dataclasses import dataclass

_GID_BYTES = 16
_NUMBERS = struct.Struct("<qqB16s")
# rmw_zenoh before 0.2.4 (Jazzy) labels each value; a label is a string with its length.
_LABELLED = struct.Struct("<16sq17sq11sB16s")
_LABELS = (b"\x0fsequence_number", b"\x10source_timestamp", b"\x0asource_gid")


@dataclass(frozen=True)
class Attachment:
    """Identity of a message; `is_old` if it has labels."""

    number: int
    sent_ns: int
    gid: bytes
    is_old: bool = False


def pack(number: int, sent_ns: int, gid: bytes) -> bytes:
    """Return the bytes of an attachment."""
    return _NUMBERS.pack(number, sent_ns, _GID_BYTES, gid)


def unpack(data: bytes) -> Attachment | None:
    """Return the contents of an attachment; None if it has an unknown format."""
    if len(data) == _NUMBERS.size:
        number, sent_ns, length, gid = _NUMBERS.unpack(data)
        is_known = length == _GID_BYTES and min(number, sent_ns) >= 0
        return Attachment(number, sent_ns, gid) if is_known else None
    if len(data) == _LABELLED.size:
        first, number, second, sent_ns, third, length, gid = _LABELLED.unpack(data)
        is_known = (first, second, third) == _LABELS and length == _GID_BYTES
        if is_known and min(number, sent_ns) >= 0:
            return Attachment(number, sent_ns, gid, is_old=True)
    return None
