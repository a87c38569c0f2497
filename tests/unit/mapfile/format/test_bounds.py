# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Limits of the YAML reader, just below and just above each."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import MapfileError, Problem, shorten
from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_BYTES, MAX_DEPTH
from rmw_manycore_py.mapfile.format.document import parse_yaml, read_yaml

pytestmark = pytest.mark.unit


def data_of(text: str) -> Any:
    return parse_yaml(text, Path("file.yaml")).data


def test_a_file_size_is_limited(tmp_path: Path) -> None:
    file = tmp_path / "file.yaml"
    file.write_text("a: 1\n".ljust(MAX_BYTES))
    assert read_yaml(file).data == {"a": 1}
    file.write_text("a: 1\n".ljust(MAX_BYTES + 1))
    with pytest.raises(MapfileError, match="expected at most 1048576 bytes, found more"):
        read_yaml(file)


def test_nesting_may_be_so_deep() -> None:
    value = data_of("[" * MAX_DEPTH + "]" * MAX_DEPTH)
    for _ in range(MAX_DEPTH - 1):
        (value,) = value
    assert value == []
    with pytest.raises(MapfileError, match="at most 50 levels of nesting, found more"):
        data_of("[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1))


def test_an_alias_is_as_deep_as_what_it_stands_for() -> None:
    half = MAX_DEPTH // 2
    anchored = f"a: &a {'[' * half}{']' * half}\n"
    fits, too_deep = MAX_DEPTH - half - 1, MAX_DEPTH - half
    assert data_of(f"{anchored}b: {'[' * fits}*a{']' * fits}\n")
    with pytest.raises(MapfileError, match=r"file.yaml:2: expected at most 50 levels of nesting"):
        data_of(f"{anchored}b: {'[' * too_deep}*a{']' * too_deep}\n")


def test_a_text_that_aliases_repeat_counts_by_its_length() -> None:
    repeated = f"a: &a {'x' * 100_000}\nb: [{', '.join(['*a'] * 200)}]\n"
    with pytest.raises(MapfileError, match=r"file.yaml:2: expected at most 100000 values"):
        data_of(repeated)


@pytest.mark.parametrize("number", [-(1 << 63), (1 << 63) - 1, (1 << 64) - 1])
def test_integers_have_64_bits(number: int) -> None:
    assert data_of(f"{number}") == number
    with pytest.raises(MapfileError, match="an integer of at most 64 bits"):
        data_of(f"{number * 2}9")


def test_a_byte_order_mark_and_line_ends_of_windows_are_read(tmp_path: Path) -> None:
    file = tmp_path / "file.yaml"
    file.write_bytes(b"\xef\xbb\xbfa: 1\r\nb: x\r\n")
    document = read_yaml(file)
    assert document.data == {"a": 1, "b": "x"}
    assert document.lines[("b",)] == 2


def test_bytes_that_are_no_text_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "file.yaml"
    file.write_bytes(b"a: \xff\n")
    with pytest.raises(MapfileError, match="a readable text file, found bytes that are not UTF-8"):
        read_yaml(file)


def test_a_problem_is_one_line() -> None:
    problem = Problem(Path("a\x1bb"), 1, "k\n" * 500, "e\0" * 500, "f\u2028\ud800" * 500)
    assert str(problem).isprintable()
    assert str(problem).startswith("a\\x1bb:1: k\\nk\\n")
    assert len(str(problem)) < 1000


def test_long_texts_are_cut() -> None:
    assert shorten("abcdef", 6) == "abcdef"
    assert shorten("abcdefg", 6) == "abc..."
    assert shorten("\x1b[31m", 20) == "\\x1b[31m"
