# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages that rosbag2 compressed one by one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import zstandard

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError


def unpacker_of(path: Path, described: Mapping[str, Any]) -> Callable[[bytes], bytes]:
    """Return the function that decompresses the messages of a recording.

    :param described: rosbag2's metadata of the recording.
    :raises ManycoreError: for another format than zstd.
    """
    if str(described.get("compression_mode", "")).upper() != "MESSAGE":
        return lambda data: data
    found = str(described.get("compression_format", ""))
    if found != "zstd":
        raise ManycoreError(
            f"{path}: expected messages compressed with zstd, found '{found}'", EXIT_BAD_INPUT
        )
    return _unpack


def _unpack(data: bytes) -> bytes:
    frame = zstandard.ZstdDecompressor().decompressobj()
    unpacked = frame.decompress(data)
    if not frame.eof:
        raise ValueError("a compressed message is cut")
    return unpacked
