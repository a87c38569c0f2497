# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings of texts, written with our own writer."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.definitions import schema_of
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.output import Output

STRING = "std_msgs/msg/String"
START_NS = 1_700_000_000_000_000_000
NS_PER_S = 1_000_000_000


def text_message(text: str) -> bytes:
    """Return a std_msgs/msg/String in CDR."""
    data = text.encode() + b"\0"
    return b"\0\1\0\0" + len(data).to_bytes(4, "little") + data


def text_in(data: bytes) -> str:
    """Return the text of a std_msgs/msg/String in CDR."""
    size = int.from_bytes(data[4:8], "little")  # Fast DDS appends padding
    return data[8 : 7 + size].decode()


def string_row(name: str, *offers: Qos, **more: Any) -> TopicRow:
    return TopicRow(name, STRING, schema=schema_of(STRING), offers=list(offers or [Qos()]), **more)


def write_texts(
    path: Path, texts: Iterable[tuple[str, float, str]], *, compression: str = "none", each: int = 0
) -> Path:
    """Write texts, each with topic and seconds after START_NS, `each` of them per chunk."""
    output = Output(path, compression)
    rows: dict[str, TopicRow] = {}
    for number, (topic, at_s, text) in enumerate(texts, start=1):
        row = rows.setdefault(topic, string_row(topic))
        at_ns = START_NS + round(at_s * NS_PER_S)
        output.write(row, at_ns, at_ns, number, text_message(text))
        if each and number % each == 0:
            output.flush()
    output.finish(list(rows.values()))
    return path
