# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated parameter files and command lines, each read here and by a node of rclpy.

Each input is derived from its number alone.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Mapping, Sequence
from copy import copy
from pathlib import Path
from typing import Any

import rclpy
import yaml
from rclpy._rclpy_pybind11 import Node as NodeHandle
from rclpy._rclpy_pybind11 import RCLError, RCLInvalidROSArgsError
from rclpy.context import Context
from rclpy.parameter import Parameter

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.launch_file import ForAllNodes, LaunchedNode
from rmw_manycore_py.mapfile.placing.parameters import (
    GeneratedFile,
    NodeName,
    given_values,
    read_all,
    sources_of,
    words_of,
)
from rmw_manycore_py.ros.parameter_files import read_file, values_for
from support.generated.mutation import mutated, mutated_lines, mutated_words
from support.nodes.ros import announce

NODES = ("/probe", "/ns/probe", "/ns/sub/probe", "/ns/sub/deep/probe_2")
SECTIONS = (
    *("/**", "/*", "/**/probe", "/*/probe", "/ns/**", "/ns/*", "/ns/*/probe", "/ns/**/probe"),
    *("/**/sub/**", "/*/*", "/*/*/*", "/**/*", "/**/**", "/*/sub/*", "/ns/sub/**/probe_2"),
    *("probe", "/probe", "ns/probe", "/ns/probe", "/ns/sub/probe", "/ns/sub", "other", "*", "**"),
)
REFUSED_SECTIONS = ("a b", "/ns//probe", "/ns/***", "/", "pro*", "ros__parameters", "é", "1probe")
NUMBERS = (
    *("-.5", "+.5", ".5", "5.", "-5.e1", "0483", "0777", "-0777", "08.5", "1e3", "1E-3", "+1e+3"),
    *("0x1F", "-0x1f", "0x1p3", "0b1", "0o17", "1_000", "1:30", "1.5.2", "9223372036854775807"),
    *("-9223372036854775808", "9223372036854775808", "18446744073709551616", "1e400", "1e-400"),
    *("nan", ".nan", ".NaN", "-nan", "inf", "-inf", "+.inf", "-.INF", ".Inf", "infinity", "+-1"),
)
WORDS = (
    *("true", "True", "TRUE", "tRue", "yes", "Yes", "on", "Off", "OFF", "n", "N", "y", "Y", "NO"),
    *("null", "~", "Null", "abc", "two words", "2024-01-01", "12:30:45", "=", "<<", "a/b", "x#y"),
    *("'1'", '"true"', "'-.5'", "''", '""', '"\\u00e9\\n"', "'it''s'", "é", "!!str 1", "!!int 0x1"),
    *("!!float 1", "!!bool yes", "!own 1", "!!str true", "! 12", "&anchor 1"),
)
REFUSED_VALUES = ("", "*anchor", "[1, 2.5]", "[1, a]", "[[1], [2]]", "[{a: 1}]", '"\\ud800"', "@x")
NAMES = ("x", "y", "z", "a.b", "qos./topic.depth", "with space", "1", "é", "on", "x")


class Generator:
    """Writes parameter files, most of which rcl takes."""

    def __init__(self, number: int) -> None:
        self._chance = random.Random(number)
        self.node = self._chance.choice(NODES)

    def file(self) -> bytes:
        """Return the bytes of a file, one of four with errors in its bytes, lines or words."""
        content = self._content()
        if self._chance.randrange(4):
            return content
        return mutated(self._chance, content, (mutated_lines, mutated_words))

    def _content(self) -> bytes:
        documents = [self._document() for _ in range(self._chance.choice((1, 1, 1, 1, 2, 3)))]
        text = "---\n".join(documents)
        if self._is_rare():
            text = text.replace("\n", "\r\n")
        kinds = ("utf-8",) * 12 + ("utf-8-sig", "utf-16", "latin-1")
        return text.encode(self._chance.choice(kinds), errors="replace")

    def values(self) -> dict[str, Any]:
        """Return values as in a launch file in Python."""
        names = self._chance.sample(("x", "y", "z", "a.b", "b_1", "odd name"), 2)
        return {name: copy(self._chance.choice(_VALUES)) for name in names}

    def command_line(self, directory: Path) -> tuple[list[Path | dict[str, Any]], bool]:
        """Return files and values of a launch file, and whether it gives a namespace."""
        sources: list[Path | dict[str, Any]] = []
        for number in range(self._chance.randrange(4)):
            kind = self._chance.randrange(4)
            if kind < 2:
                file = directory / f"given{number}.yaml"
                file.write_text("".join(self._section(refused=False) for _ in range(2)))
                sources.append(file)
            else:
                values = self.values()
                sources.append(ForAllNodes(values) if kind == 2 else values)
        return sources, self._chance.random() < 0.5

    def _is_rare(self) -> bool:
        return self._chance.random() < 0.03

    def _document(self) -> str:
        if self._is_rare():
            return self._chance.choice(("", "a: 1\n", "- a\n", "# nothing\n", "a:\n", "text\n"))
        sections = [self._section() for _ in range(self._chance.randrange(1, 5))]
        return "# a comment\n" * self._is_rare() + "".join(sections)

    def _section(self, refused: bool = True) -> str:
        is_refused = refused and self._is_rare()
        name = self._chance.choice(REFUSED_SECTIONS if is_refused else SECTIONS)
        lines = self._mapping(refused) if refused or self._chance.random() < 0.9 else ["x: 1"]
        parts = name.strip("/").split("/")
        if len(parts) > 1 and self._chance.random() < 0.2 and not is_refused:  # nested names
            keys = [f"/{parts[0]}", *parts[1:], "ros__parameters"]
        else:
            keys = [name, "ros__parameters"]
        heads = [f"{'  ' * depth}{_key(key)}:\n" for depth, key in enumerate(keys)]
        if self._chance.random() < 0.2:
            flow = self._flow(refused)
            return "".join(heads[:-1]) + f"{heads[-1].rstrip()} {flow}\n"
        indent = "  " * len(keys)
        return "".join(heads) + "".join(f"{indent}{line}\n" for line in lines)

    def _mapping(self, refused: bool, depth: int = 0) -> list[str]:
        lines: list[str] = []
        for _ in range(self._chance.randrange(1, 5)):
            name = _key(self._chance.choice(NAMES))
            kind = self._chance.randrange(12)
            if kind == 0 and depth < 3:
                lines.append(f"{name}:")
                lines += [f"  {line}" for line in self._mapping(refused, depth + 1)]
            elif kind == 1:
                lines.append(f"{name}:")
                lines += [f"- {item}" for item in self._items(refused)]
            elif kind == 2:
                lines += [f"{name}: {self._chance.choice('|>')}", "  a text", "  of two lines"]
            else:
                lines.append(f"{name}: {self._value(refused)}")
        return lines

    def _flow(self, refused: bool) -> str:
        pairs = [f"{_key(name)}: {self._value(refused)}" for name in self._chance.sample(NAMES, 2)]
        return "{" + ", ".join(pairs) + "}"

    def _value(self, refused: bool) -> str:
        if refused and self._chance.random() < 0.01:
            return self._chance.choice(REFUSED_VALUES)
        kind = self._chance.randrange(10)
        if kind == 0:
            return f"[{', '.join(self._items(refused))}]"
        if kind == 1:
            return self._chance.choice(("[]", "{}", "[ ]")) if self._is_rare() else "[1, 2]"
        return self._chance.choice(NUMBERS if kind < 6 else WORDS)

    def _items(self, refused: bool) -> Sequence[str]:
        kinds = (("1", "2"), (".5", "-1e3", "nan"), ("true", "no"), ("a", "'1'"), ("0x10", "07"))
        items = self._chance.choice(kinds)
        return (*items, "mixed") if refused and self._is_rare() else items


_VALUES = (1, -0.5, 1e-9, True, "text", "1", "1e-9", "-.5", "y", "true", "é\n", "", "nan", [1, 2])
_VALUES += ([1e-9, 2.0], ["a", "1"], [True, False], "0483", "\x7f", "a: b", "'", 1 << 40)


def _key(name: str) -> str:
    return f"'{name}'" if name.startswith(("*", "<", "=")) or " " in name else name


def overrides_of(context: Context, full_name: str, words: Sequence[str]) -> dict[str, Any]:
    """Return the parameters that a node of this process gets from its command line."""
    namespace, _, name = full_name.rpartition("/")
    arguments = ["--ros-args", *words]
    with context.handle:
        node = NodeHandle(name, namespace, context.handle, arguments, False, False)
        with node:
            found = node.get_parameters(Parameter)
        node.destroy_when_not_in_use()
    return {name: one.value for name, one in found.items() if one.value is not None}


def print_overrides(*words: str) -> None:
    """Run a node with a command line, and print the parameters that it gets from it."""
    rclpy.init(args=list(words))
    node = rclpy.create_node("probe", namespace="/ns")
    found = node._parameter_overrides.items()
    announce(repr(shown({name: one.value for name, one in found if one.value is not None})))
    rclpy.shutdown()


def difference(expected: Mapping[str, Any], found: Mapping[str, Any]) -> str | None:
    """Return how two mappings differ."""
    one, other = shown(expected), shown(found)
    return None if one == other else f"expected {one}, found {other}"


def shown(values: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return values such that types count, and NaN equals itself."""
    return sorted((name, repr(value)) for name, value in values.items())


def read_here(file: Path, full_name: str) -> dict[str, Any] | MapfileError:
    """Return the parameters of a node in a file, or why the file is refused."""
    try:
        return values_for(read_file(file), full_name)
    except MapfileError as error:
        return error


def compare_files(context: Context, directory: Path, numbers: range) -> tuple[Counter[str], str]:
    """Read files here and by a node; return how often each outcome occurred, and a difference."""
    outcomes: Counter[str] = Counter()
    for number in numbers:
        generator = Generator(number)
        file = directory / "file.yaml"
        file.write_bytes(generator.file())
        found = read_here(file, generator.node)
        try:
            expected = overrides_of(context, generator.node, ["--params-file", str(file)])
        except (RCLInvalidROSArgsError, RCLError):
            outcomes["refused"] += 1
            if not isinstance(found, MapfileError):
                return (
                    outcomes,
                    f"file {number} is refused by the node alone: {file.read_bytes()!r}",
                )
            continue
        outcomes["some" if expected else "none"] += 1
        if isinstance(found, MapfileError):
            return outcomes, f"file {number} is refused by us alone: {found}"
        if (text := difference(expected, found)) is not None:
            return outcomes, f"file {number}, {generator.node}: {text}\n{file.read_bytes()!r}"
    return outcomes, ""


def compare_command_lines(context: Context, directory: Path, numbers: range) -> str:
    """Compare our command lines with those of `ros2 launch`; return a difference.

    Values of the mapfile, which come last, win.
    """
    for number in numbers:
        generator = Generator(number)
        given, has_namespace = generator.command_line(directory)
        launched = LaunchedNode(
            *(Path("demo.launch.py"), 1, "probe", "/", "package", "executable", (), tuple(given)),
            *((), (), (), {}, has_namespace),
        )
        own = generator.values() if number % 2 else {}
        text = _difference_of(context, generator.node, directory, launched, own)
        if text is not None:
            return f"command line {number}, {generator.node}: {text}\n{given}\n{own}"
    return ""


def print_comparison(directory: str, first: int, end: int) -> None:
    """Compare files and command lines in this process, and print the differences."""
    rclpy.init()
    arguments = rclpy.get_default_context(), Path(directory), range(first, end)
    announce(repr([compare_files(*arguments)[1], compare_command_lines(*arguments)]))
    rclpy.shutdown()


def _difference_of(
    context: Context, name: str, directory: Path, launched: LaunchedNode, own: dict[str, Any]
) -> str | None:
    try:
        expected = overrides_of(context, name, _of_launch(launched, name, directory))
    except RCLInvalidROSArgsError:
        expected = None
    try:
        sources = sources_of(launched, [], own, NodeName(name))
    except MapfileError as error:
        return None if expected is None else str(error)
    if expected is None:
        return "refused by the node alone"
    words = [_written(word, directory) for word in words_of(sources, "probe")]
    files = [one for one in sources if isinstance(one, Path)]
    views = (
        overrides_of(context, name, words),
        values_for(read_all(sources), name),
        {**values_for(read_all(files), name), **given_values(sources, None, name)},
    )
    texts = (difference({**expected, **own}, view) for view in views)
    return next((f"{text}\n{words}" for text in texts if text is not None), None)


def _written(word: str | GeneratedFile, directory: Path) -> str:
    if isinstance(word, str):
        return word
    path = directory / word.name
    path.write_text(word.text)
    return str(path)


def _of_launch(launched: LaunchedNode, full_name: str, directory: Path) -> list[str]:
    """Return the options as launch_ros 0.26 writes them: a file for each dictionary."""
    words: list[str] = []
    for number, source in enumerate(launched.parameters):
        path = source
        if isinstance(source, dict):
            is_for_all = isinstance(source, ForAllNodes) or not launched.is_fully_named
            section = "/**" if is_for_all else full_name
            path = directory / f"launch_params_{number}"
            path.write_text(yaml.dump({section: {"ros__parameters": dict(source)}}))
        words += ["--params-file", str(path)]
    return words
