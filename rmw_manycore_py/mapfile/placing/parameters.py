# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of a node, in the order in which rcl reads them from its command line.

rcl ranks the sections of all files and options by the first appearance of their names, whatever
file they are in. What a launch file gives is ranked as under `ros2 launch`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import yaml
from typing_extensions import override

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file import (
    ExpandedFile,
    ForAllNodes,
    GivenByName,
    LaunchedComponent,
    LaunchedNode,
    ParameterSource,
)
from rmw_manycore_py.mapfile.placing.parameter_values import Values
from rmw_manycore_py.ros.parameter_files import (
    ALL_NODES,
    Sections,
    add_file,
    add_text,
    applies,
    read_text,
    values_for,
)
from rmw_manycore_py.ros.rcl_parser import Overrides, RclError, overrides

Launched = LaunchedNode | LaunchedComponent
Source = Path | ExpandedFile | Values
_FILE_OPTION, _VALUE_OPTIONS = "--params-file", ("-p", "--param")


@dataclass(frozen=True)
class GeneratedFile:
    """A parameter file that is written before the node starts."""

    name: str
    text: str


@dataclass(frozen=True)
class NodeName:
    """Full name of a node; without `is_given` its code may have another one."""

    full: str
    is_given: bool = True


def sources_of(
    launched: Launched | None, files: Sequence[Path], own: Mapping[str, Any], node: NodeName
) -> tuple[Source, ...]:
    """Return the sources of a node's parameters in the order of its command line.

    The launch file's come first, then `files`, then the mapfile's `own` values, which always win.

    :raises MapfileError: for a file that rcl refuses.
    """
    sources: list[Source] = []
    if launched is not None:
        for source in launched.parameters:
            if not isinstance(source, dict):
                sources.append(source)
            elif values := _typed_by_rcl(source, launched):
                sources.append(_addressed(source, values, launched, sources, node))
    sources += files
    sections = read_all(sources, launched)
    return (*sources, *((_winning(own, sections, node),) if own else ()))


def given_values(
    sources: Sequence[Source], launched: Launched | None, full_name: str
) -> dict[str, Any]:
    """Return the effective parameters that are not in the user's files."""
    files = [source for source in sources if isinstance(source, Path)]
    if len(files) == len(sources) and not any(_parameter_options(launched)):
        return {}
    from_files = values_for(read_all(files), full_name)
    effective = values_for(read_all(sources, launched), full_name)
    return {
        name: value
        for name, value in effective.items()
        if name not in from_files or repr(value) != repr(from_files[name])  # 1 is not True
    }


def read_all(sources: Iterable[Source], launched: Launched | None = None) -> Sections:
    """Return the sections that rcl reads from a command line.

    :param launched: node of the launch file, whose own ROS arguments come first.
    :raises MapfileError: for a file that rcl refuses.
    """
    with overrides() as read:
        for option, word in _parameter_options(launched):
            if option != _FILE_OPTION:
                _add_option(read, word, launched)
            elif os.path.isfile(word):  # else it may exist in the node's own directory
                add_file(read, Path(word))
        for source in sources:
            if isinstance(source, Path):
                add_file(read, source)
            elif isinstance(source, ExpandedFile):
                add_text(read, source.text, source.file)
            else:
                add_text(read, source.text, Path(source.section))
        return read.sections()


def words_of(sources: Sequence[Source], stem: str) -> list[str | GeneratedFile]:
    """Return the options for the command line of a node."""
    words: list[str | GeneratedFile] = []
    for source, name in zip(sources, file_names(sources, stem), strict=True):
        if isinstance(source, Path):
            words += [_FILE_OPTION, str(source)]
        elif isinstance(source, Values) and source.options is not None:
            words += source.options
        else:
            words += [_FILE_OPTION, GeneratedFile(name, source.text)]
    return words


def file_names(sources: Sequence[Source], stem: str) -> list[str]:
    """Return a name for each source as a file: numbered, except for values that come last."""
    names = [f"{stem}.{number}.yaml" for number in range(1, len(sources) + 1)]
    return [*names[:-1], f"{stem}.yaml"] if sources and isinstance(sources[-1], Values) else names


def _typed_by_rcl(source: Mapping[str, Any], launched: Launched) -> dict[str, Any]:
    """Return values as rcl reads them from the file or the options that launch writes."""
    if not source:
        return {}
    if isinstance(source, GivenByName):
        with overrides() as read:
            for name, value in source.items():
                _add_option(read, f"{name}:={value}", launched)
            return values_for(read.sections(), "/any")
    text = yaml.dump({ALL_NODES: {"ros__parameters": dict(source)}}, Dumper=_Dumper)
    try:
        return values_for(read_text(text, launched.file), "/any")
    except MapfileError as error:
        raise MapfileError(_refused(launched, error.problems[0].found)) from error


class _Dumper(yaml.SafeDumper):
    """Writes repeated lists in full, since rcl refuses aliases."""

    @override
    def ignore_aliases(self, data: Any) -> bool:
        return True


def _parameter_options(launched: Launched | None) -> Iterator[tuple[str, str]]:
    words = launched.ros_arguments if isinstance(launched, LaunchedNode) else ()
    for option, word in pairwise(words):
        if option in (_FILE_OPTION, *_VALUE_OPTIONS):
            yield option, word


def _add_option(read: Overrides, word: str, launched: Launched | None) -> None:
    name, _, text = word.partition(":=")
    section, _, name = name.rpartition(":")
    try:
        read.add_value(section or ALL_NODES, name, text)
    except RclError as error:
        raise MapfileError(_refused(launched, f"{word}: {error}")) from error


def _addressed(
    source: ParameterSource,
    values: Mapping[str, Any],
    launched: Launched,
    earlier: Sequence[Source],
    node: NodeName,
) -> Values:
    """Return values in the section that launch puts them in."""
    if isinstance(launched, LaunchedComponent):  # launch applies them one after the other
        return _winning(values, read_all(earlier, launched), node)
    if isinstance(source, ForAllNodes) or not launched.is_fully_named:
        return Values(ALL_NODES, values, by_option=True)
    return Values(node.full, values, by_option=False)


def _winning(values: Mapping[str, Any], earlier: Sections, node: NodeName) -> Values:
    """Return values in a section of the node that ranks after all earlier ones."""
    names = [name for name, _ in earlier]
    competing = [name for name in names if not node.is_given or applies(name, node.full)]
    section = node.full if node.is_given else ALL_NODES
    while section in names:
        section = f"{ALL_NODES}{section}"
    # In one section rcl keeps a value of each type: another type does not replace the first one.
    before = dict(earlier).get(ALL_NODES, {})
    has_room = all(_kind(before[n]) == _kind(v) for n, v in values.items() if n in before)
    return Values(section, values, by_option=has_room and ALL_NODES not in competing[:-1])


def _kind(value: Any) -> tuple[type, ...]:
    return (list, *{type(item) for item in value}) if isinstance(value, list) else (type(value),)


def _refused(launched: Launched | None, found: str) -> Problem:
    assert launched is not None
    place = (launched.file, launched.line, launched.label)
    return Problem(*place, "parameters that rcl reads", found)
