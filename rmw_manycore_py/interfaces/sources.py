# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finds packages of definitions in the user's directories."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from rosidl_adapter.parser import is_valid_package_name
from rosidl_pycommon import convert_camel_case_to_lower_case_underscore

from rmw_manycore_py.errors import EXIT_BAD_INPUT, DefinitionError, ManycoreError, Problem
from rmw_manycore_py.interfaces.definition import KINDS, Definition, read_definition
from rmw_manycore_py.ros.workspace import walk_sources

_SUFFIXES = {*(f".{kind}" for kind in KINDS), ".idl"}
# First line of an .idl file converted from a .msg, .srv or .action file beside it.
_CONVERTED = "// generated from rosidl_adapter/"


@dataclass(frozen=True)
class Source:
    """Definitions of a package, by type name."""

    package: str
    directory: Path
    definitions: dict[str, Definition]
    available: int  # number of definitions in the package, possibly more than selected


def find_sources(paths: Iterable[Path]) -> dict[str, Source]:
    """Return the packages in and below paths, by name.

    :raises DefinitionError: with all problems found.
    """
    found: dict[str, Source] = {}
    problems: list[Problem] = []
    for path in paths:
        directories = list(_package_directories(path.resolve()))
        if not directories:
            expected = "expected an interface package, or a directory pkg/{msg,srv,action}"
            raise ManycoreError(f"{path}: {expected}, found no definitions", EXIT_BAD_INPUT)
        for directory in directories:
            try:
                source = read_source(directory)
                _add(found, source)
            except DefinitionError as error:
                problems += error.problems
    if problems:
        raise DefinitionError(*problems)
    return found


def read_source(directory: Path) -> Source:
    """Read all definitions of a package."""
    package = _package_name(directory)
    definitions: dict[str, Definition] = {}
    problems: list[Problem] = []
    for file in _definition_files(directory):
        try:
            definition = read_definition(file, package)
        except DefinitionError as error:
            problems += error.problems
            continue
        other = definitions.setdefault(definition.name, definition)
        if other is not definition:
            problems.append(Problem(file, 0, "", "one definition of each type", str(other.file)))
    problems += _alike(definitions.values())
    if problems:
        raise DefinitionError(*problems)
    return Source(package, directory, definitions, len(definitions))


def _add(found: dict[str, Source], source: Source) -> None:
    other = found.setdefault(source.package, source)
    if _texts(other) != _texts(source):
        expected = f"one package '{source.package}'"
        raise DefinitionError(Problem(source.directory, 0, "", expected, str(other.directory)))


def _texts(source: Source) -> dict[str, bytes]:
    return {name: d.file.read_bytes() for name, d in source.definitions.items()}


def _alike(definitions: Iterable[Definition]) -> Iterator[Problem]:
    """Yield types whose generated files would have the same name: FooBAR and FooBar."""
    seen: dict[tuple[str, str], Definition] = {}
    for definition in definitions:
        stem = convert_camel_case_to_lower_case_underscore(definition.file.stem)
        other = seen.setdefault((definition.kind, stem), definition)
        if other is not definition:
            expected = f"a name whose generated files, {stem}.h, are not those of {other.file.name}"
            yield Problem(definition.file, 0, "", expected, definition.file.name)


def _package_directories(path: Path) -> Iterator[Path]:
    if not path.is_dir():
        raise ManycoreError(
            f"{path}: expected a directory, found no such directory", EXIT_BAD_INPUT
        )
    for directory, directories, _ in walk_sources(path):
        if any(_definition_files(directory)):
            yield directory
            directories.clear()


def _definition_files(directory: Path) -> Iterator[Path]:
    for kind in KINDS:
        for file in sorted(directory.glob(f"{kind}/*.*")):
            if file.suffix in _SUFFIXES and not _is_converted(file):
                yield file


def _is_converted(file: Path) -> bool:
    if file.suffix != ".idl":
        return False
    with file.open("rb") as content:
        made = content.readline().startswith(_CONVERTED.encode())
    return made and file.with_suffix(f".{file.parent.name}").exists()


def _package_name(directory: Path) -> str:
    file = directory / "package.xml"
    name = directory.name
    if file.is_file():
        try:
            name = (ET.parse(file).getroot().findtext("name") or "").strip()
        except (ET.ParseError, LookupError, ValueError) as error:  # the latter: of its encoding
            line = error.position[0] if isinstance(error, ET.ParseError) else 1
            raise DefinitionError(Problem(file, line, "", "XML", str(error))) from error
    if not is_valid_package_name(name):
        expected = "a package name of lower-case letters, digits and single underscores"
        place = file if file.is_file() else directory
        raise DefinitionError(Problem(place, 0, "name", expected, f"'{name}'"))
    return name
