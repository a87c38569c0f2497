# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What an import of LTTng traces refuses, each in one line."""

from __future__ import annotations

import struct
import uuid
from pathlib import Path

import pytest

from rmw_manycore_py.errors import FileError
from rmw_manycore_py.profile.importing import import_source
from rmw_manycore_py.profile.ros2_tracing import Window
from support.generated.ctf import FROM_TOPIC, begin, end, node, subscription, write_trace

pytestmark = [pytest.mark.unit, pytest.mark.needs("babeltrace2")]

EVENTS = [
    *node(1, "n"),
    *subscription(1, "/in"),
    begin(1, 1, 1, FROM_TOPIC),
    end(2, 1, 1, FROM_TOPIC),
]
SECOND_NS = 10**9


def packets(text: bytes, order: str, size: int = 4096) -> bytes:
    """Return metadata in packets of one size, as LTTng writes them."""
    parts = [text[at : at + size - 37] for at in range(0, len(text), size - 37)]
    own = uuid.uuid4().bytes
    return b"".join(
        struct.pack(f"{order}I16sIII", 0x75D11D57, own, 0, 8 * (37 + len(part)), 8 * size)
        + bytes((0, 0, 0, 1, 8))
        + part.ljust(size - 37, b"\0")
        for part in parts
    )


def test_traces_of_two_hosts_are_two_applications(tmp_path: Path) -> None:
    write_trace(tmp_path / "kernel", EVENTS)
    write_trace(tmp_path / "user", EVENTS)
    assert import_source(tmp_path, Window()).callbacks
    write_trace(tmp_path / "other", EVENTS, host="other")
    with pytest.raises(FileError, match=r"one session .*, found kernel and other"):
        import_source(tmp_path, Window())


@pytest.mark.parametrize("order", "<>")
def test_metadata_that_are_cut_off_are_refused(order: str, tmp_path: Path) -> None:
    trace = write_trace(tmp_path / "trace", EVENTS)
    metadata = trace / "metadata"
    whole = packets(metadata.read_bytes(), order)
    assert len(whole) > 4096
    for size in (len(whole) - 1, 4096 + 36, 100, 5):
        metadata.write_bytes(whole[:size])
        with pytest.raises(FileError, match=r"metadata: expected whole packets .*found a part"):
            import_source(trace, Window())
    metadata.write_bytes(whole[:4096] + b"\0" * 4096)
    with pytest.raises(FileError, match=r"found a part at byte 4096"):
        import_source(trace, Window())


def test_metadata_in_packets_are_read(tmp_path: Path) -> None:
    trace = write_trace(tmp_path / "trace", EVENTS)
    metadata = trace / "metadata"
    metadata.write_bytes(packets(metadata.read_bytes(), "<"))
    assert import_source(trace, Window()).callbacks


def test_a_window_without_callbacks_is_refused(tmp_path: Path) -> None:
    trace = write_trace(tmp_path / "trace", EVENTS)
    with pytest.raises(FileError, match=r"expected callbacks .* --begin and --end, found none"):
        import_source(trace, Window(SECOND_NS))
