# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parses `$(name argument ...)` in XML and YAML launch files."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from typing import Any

from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_DEPTH
from rmw_manycore_py.mapfile.launch_file import file_substitutions as f
from rmw_manycore_py.mapfile.launch_file import substitutions as s
from rmw_manycore_py.mapfile.launch_file.command import Command
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import Substitution, TextSubstitution

Parts = list[Substitution]
_BY_NAME: dict[str, tuple[int, int, Callable[..., Substitution]]] = {
    "var": (1, 2, lambda name, default=None: s.LaunchConfiguration(name, default=default)),
    "env": (1, 2, lambda name, default=None: s.EnvironmentVariable(name, default_value=default)),
    "find-pkg-share": (1, 1, s.FindPackageShare),
    "find-pkg-prefix": (1, 1, s.FindPackagePrefix),
    "exec-in-pkg": (2, 2, s.ExecutableInPackage),
    "find-exec": (1, 1, lambda name: s.FindExecutable(name=name)),
    "filename": (0, 0, s.ThisLaunchFile),
    "dirname": (0, 0, s.ThisLaunchFileDir),
    "eval": (1, 2, s.PythonExpression),
    "command": (1, 2, lambda line, on_stderr="fail": Command(line, on_stderr=on_stderr)),
    "not": (1, 1, s.NotSubstitution),
    "all": (1, 99, s.AllSubstitution),
    "any": (1, 99, s.AnySubstitution),
    "anon": (1, 1, f.AnonName),
    "file-content": (1, 1, f.FileContent),
    "launch_log_dir": (0, 0, f.LaunchLogDir),
    "log_dir": (0, 0, f.LaunchLogDir),
    "param": (1, 2, lambda name, default=None: f.Parameter(name, default=default)),
    "and": (2, 2, s.AndSubstitution),
    "or": (2, 2, s.OrSubstitution),
    "equals": (2, 2, s.EqualsSubstitution),
    "not-equals": (2, 2, s.NotEqualsSubstitution),
    "if": (2, 3, s.IfElseSubstitution),
}


# Private-use characters replace substitutions while a line is split.
_PLACEHOLDER = 0xF0000


def parse(text: str) -> Parts:
    """Split a text into literal parts and substitutions."""
    reader = _Reader(text)
    parts = reader.parts(lambda _char: False)
    return parts or [TextSubstitution(text="")]


def split_words(parts: Parts) -> list[Parts]:
    """Split a command line at spaces; the values of substitutions are never split."""
    line = "".join(
        part.text if isinstance(part, TextSubstitution) else chr(_PLACEHOLDER + index)
        for index, part in enumerate(parts)
    )
    try:
        words = shlex.split(line)
    except ValueError as error:
        raise LaunchFileError("a command line as in a shell", f"{line!r}: {error}") from error
    return [[_part(char, parts) for char in word] for word in words]


def _part(char: str, parts: Parts) -> Substitution:
    index = ord(char) - _PLACEHOLDER
    return parts[index] if 0 <= index < len(parts) else TextSubstitution(text=char)


class _Reader:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._depth = 0

    def parts(self, ends: Callable[[str], bool]) -> Parts:
        """Parse up to the first character outside substitutions for which `ends` holds."""
        parts: Parts = []
        plain = ""
        while self._at < len(self._text) and not ends(self._text[self._at]):
            # In launch any backslash before a dollar escapes it, even one that is escaped itself.
            is_escaped = self._text[self._at - 1 : self._at] == "\\"
            if self._text.startswith("$(", self._at) and not is_escaped:
                parts += [TextSubstitution(text=plain)] if plain else []
                plain = ""
                parts.append(self._substitution())
                continue
            if self._text[self._at] == "\\" and self._text[self._at + 1 : self._at + 2].strip("\n"):
                self._at += 1  # launch takes any character after a backslash as it is
            plain += self._text[self._at : self._at + 1]
            self._at += 1
        return parts + ([TextSubstitution(text=plain)] if plain else [])

    def _substitution(self) -> Substitution:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise LaunchFileError(f"at most {MAX_DEPTH} levels of substitutions", "more")
        self._at += len("$(")
        start = self._at
        while self._at < len(self._text) and self._text[self._at] not in " \t\n)":
            self._at += 1
        name = self._text[start : self._at]
        arguments = self._arguments()
        if name not in _BY_NAME:
            raise LaunchFileError(f"one of the substitutions {', '.join(_BY_NAME)}", f"'$({name})'")
        min_count, max_count, make = _BY_NAME[name]
        if not min_count <= len(arguments) <= max_count:
            count = f"{min_count}" if min_count == max_count else f"{min_count} to {max_count}"
            raise LaunchFileError(f"{count} argument(s) of $({name})", str(len(arguments)))
        self._depth -= 1
        return make(*arguments)

    def _arguments(self) -> list[Any]:
        arguments: list[Parts] = []
        while True:
            while self._at < len(self._text) and self._text[self._at] in " \t\n":
                self._at += 1
            if self._at >= len(self._text):
                raise LaunchFileError("a closing ')'", repr(self._text))
            if self._text[self._at] == ")":
                self._at += 1
                return arguments
            arguments.append(self._argument(self._text[self._at]))

    def _argument(self, quote: str) -> Parts:
        if quote not in "\"'":
            return self.parts(lambda char: char in " \t\n)")
        self._at += 1
        parts = self.parts(lambda char: char == quote)
        if self._at >= len(self._text):
            raise LaunchFileError(f"a closing {quote}", repr(self._text))
        self._at += 1
        return parts
