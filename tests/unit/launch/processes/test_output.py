# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lines read from a pipe."""

import os
from collections.abc import Iterator
from typing import IO

import pytest

from rmw_manycore_py.launch.processes.output import LONGEST_LINE_BYTES, TAIL_LINES, OutputReader

pytestmark = pytest.mark.unit


@pytest.fixture
def pipe() -> Iterator[tuple[OutputReader, IO[bytes]]]:
    reading, writing = os.pipe()
    with os.fdopen(reading, "rb", buffering=0) as source, os.fdopen(writing, "wb", 0) as sink:
        yield OutputReader(source), sink


def test_lines_come_when_they_are_complete(pipe: tuple[OutputReader, IO[bytes]]) -> None:
    reader, sink = pipe
    assert reader.read_lines() == []
    sink.write(b"one\r\ntw")
    assert reader.read_lines() == ["one"]
    sink.write(b"o\n\n")
    assert reader.read_lines() == ["two", ""]
    assert not reader.at_end


def test_the_end_is_seen_and_the_rest_kept(pipe: tuple[OutputReader, IO[bytes]]) -> None:
    reader, sink = pipe
    sink.write(b"whole\nrest")
    sink.close()
    assert reader.read_lines() == ["whole"]
    assert reader.read_lines() == []
    assert reader.at_end
    assert reader.close() == ["rest"]


def test_closing_reads_what_is_still_there(pipe: tuple[OutputReader, IO[bytes]]) -> None:
    reader, sink = pipe
    sink.write(b"one\ntwo\n")
    assert reader.close() == ["one", "two"]


def test_an_endless_line_is_cut(pipe: tuple[OutputReader, IO[bytes]]) -> None:
    reader, sink = pipe
    sink.write(b"x" * LONGEST_LINE_BYTES)
    assert reader.read_lines() == ["x" * LONGEST_LINE_BYTES]


def test_the_tail_is_bounded(pipe: tuple[OutputReader, IO[bytes]]) -> None:
    reader, sink = pipe
    sink.write(b"".join(b"%d\n" % number for number in range(TAIL_LINES + 5)))
    reader.read_lines()
    assert list(reader.tail) == [str(number) for number in range(5, TAIL_LINES + 5)]
