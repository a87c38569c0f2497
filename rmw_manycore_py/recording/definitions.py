# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The definition of a type and of all types in it, in one text, as MCAP's schemas have it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rmw_manycore_py.errors import DefinitionError
from rmw_manycore_py.interfaces.definition import read_definition
from rmw_manycore_py.ros.ament import package_share

_RULE = "=" * 80
_ENCODINGS = {".msg": "ros2msg", ".idl": "ros2idl"}


@dataclass(frozen=True)
class Schema:
    """The definition of a type as a recording has it; without one, both are empty."""

    encoding: str = ""
    text: str = ""


NO_SCHEMA = Schema()


@cache
def schema_of(type_name: str) -> Schema:
    """Return the schema of a type, without a definition where it is not installed.

    A tree of types is written in `.msg` or, if one of them has no such file, in `.idl`.
    """
    for suffix, encoding in _ENCODINGS.items():
        texts = _texts(type_name, suffix)
        if texts is not None:
            return Schema(encoding, _joined(texts, suffix))
    return NO_SCHEMA


def _texts(root: str, suffix: str) -> dict[str, str] | None:
    """Return the definitions of a type and of all in it, None where a file is missing."""
    texts: dict[str, str] = {}
    waiting = [root]
    while waiting:
        name = waiting.pop()
        if name in texts:
            continue
        file = _file(name, suffix)
        if file is None:
            return None
        try:
            references = read_definition(file, name.split("/")[0]).references
        except DefinitionError:
            return None
        texts[name] = file.read_text(encoding="utf-8")
        waiting.extend(reversed(references))
    return texts


def _file(type_name: str, suffix: str) -> Path | None:
    package, kind, name = type_name.split("/")
    share = package_share(package)
    file = share / kind / f"{name}{suffix}" if share else None
    return file if file is not None and kind == "msg" and file.is_file() else None


def _joined(texts: dict[str, str], suffix: str) -> str:
    """Join them: the root first, each other one, and in IDL the root too, below its name."""
    parts = []
    for name, text in texts.items():
        if suffix == ".idl":
            parts.append(f"{_RULE}\nIDL: {name}\n{text}")
        elif parts:
            package, _, short = name.split("/")
            parts.append(f"{_RULE}\nMSG: {package}/{short}\n{text}")
        else:
            parts.append(text)
    return "\n".join(parts)
