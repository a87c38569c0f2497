# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters by rcl's rules: its own library reads files and values, and ranks their sections.

Only which sections are those of a node is decided here, as rclcpp and rclpy decide it.
"""

from __future__ import annotations

import os
import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.ros.rcl_parser import Overrides, RclError, overrides

ALL_NODES = "/**"  # the section of values given by -p
_EXPECTED = "a parameter file that rcl reads"
_LINE = re.compile(r",? ?(?:Error )?(?:at|near) line(?:_num)? (\d+)")
_SYNTAX = "Error parsing a event"

Sections = list[tuple[str, dict[str, Any]]]


def read_file(path: Path) -> Sections:
    """Return the sections of a parameter file; raise MapfileError if rcl refuses it."""
    with overrides() as read:
        add_file(read, path)
        return read.sections()


def read_text(text: str, origin: Path) -> Sections:
    """Return the sections of the text of a parameter file."""
    with overrides() as read:
        add_text(read, text, origin)
        return read.sections()


def read_scalar(text: str) -> Any:
    """Return the value of an unquoted scalar, typed as in a parameter file."""
    with overrides() as read:
        try:
            read.add_value(ALL_NODES, "scalar", text)
        except RclError:  # not a scalar on its own, e.g. `---`
            return text
        value = read.sections()[0][1]["scalar"]
    return text if value is None or isinstance(value, str) else value


def add_file(read: Overrides, path: Path) -> None:
    """Add a file; raise MapfileError with its line if rcl refuses it."""
    try:
        with path.open("rb"):
            pass
        read.add_file(path)
    except OSError as error:
        found = error.strerror or "none"
        raise MapfileError(Problem(path, 0, "", "a readable parameter file", found)) from error
    except RclError as error:
        raise MapfileError(_problem(path, path.read_bytes(), str(error))) from error


def add_text(read: Overrides, text: str, origin: Path) -> None:
    """Add the text of a file; errors name `origin`."""
    content = text.encode(errors="replace")
    try:
        with _as_file(content) as path:
            read.add_file(path)
    except RclError as error:
        raise MapfileError(_problem(origin, content, str(error))) from error


def values_for(sections: Iterable[tuple[str, Mapping[str, Any]]], full_name: str) -> dict[str, Any]:
    """Return the parameters of a node: of the sections that apply to it, the last one wins.

    A parameter without a value, such as an empty list, is left out.
    """
    found: dict[str, Any] = {}
    for section, values in sections:
        if applies(section, full_name):
            found |= values
    return {name: value for name, value in found.items() if value is not None}


def applies(section: str, full_name: str) -> bool:
    """Return whether a section is one of a node: `*` is one part of a name, `**` any number."""
    parts = full_name.strip("/").split("/")
    reached = {0}  # numbers of parts that the section may have matched so far
    for wanted in section.strip("/").split("/"):
        if wanted == "**":
            reached = set(range(min(reached), len(parts) + 1)) if reached else set()
        else:
            next_parts = (i for i in reached if i < len(parts) and wanted in ("*", parts[i]))
            reached = {i + 1 for i in next_parts}
    return len(parts) in reached


@contextmanager
def _as_file(content: bytes) -> Iterator[str]:
    """Yield a path of a file in memory, since rcl only reads files."""
    descriptor = os.memfd_create("parameters", os.MFD_CLOEXEC)
    with open(descriptor, "wb", buffering=0) as file:
        file.write(content)
        yield f"/proc/self/fd/{descriptor}"


def _problem(path: Path, content: bytes, error: str) -> Problem:
    """Return rcl's error with its line."""
    place = _LINE.search(error)
    text = _LINE.sub("", error).strip()
    if text == _SYNTAX and (syntax := _syntax_error(content)):
        return Problem(path, syntax[0], "", _EXPECTED, syntax[1])
    line = int(place[1]) if place else _line_of(content, error)
    return Problem(path, line, "", _EXPECTED, f"its error: {text}")


def _syntax_error(content: bytes) -> tuple[int, str] | None:
    """Return line and text of a syntax error, since rcl's error has neither."""
    try:
        for _ in yaml.parse(content, yaml.SafeLoader):
            pass
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        found = str(error.problem or error.context)
        return mark.line + 1 if mark else 0, found.removeprefix("but ").removeprefix("found ")
    except yaml.reader.ReaderError as error:
        return 0, error.reason
    except (ValueError, OverflowError):
        return 0, "a number that is too large"
    return None


def _line_of(content: bytes, error: str) -> int:
    """Return the line that rcl refuses with an error that does not name it.

    It is the last line of the shortest beginning of the file that rcl refuses in the same way.
    """
    lines = content.splitlines(keepends=True)

    def is_refused(count: int) -> bool:
        with overrides() as read, _as_file(b"".join(lines[:count])) as path:
            try:
                read.add_file(path)
            except RclError as found:
                return str(found) == error
            return False

    return bisect_left(range(len(lines) + 1), True, key=is_refused)
