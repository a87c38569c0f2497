# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Type definitions including nested types, as used in MCAP schemas."""

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
    """Definition of a type in a recording; both fields are empty without a definition."""

    encoding: str = ""
    text: str = ""


NO_SCHEMA = Schema()


@cache
def schema_of(type_name: str) -> Schema:
    """Return the schema of a type; without a definition if it is not installed.

    Uses `.msg`, or `.idl` if one of the nested types has no `.msg` file.
    """
    for suffix, encoding in _ENCODINGS.items():
        texts = _texts(type_name, suffix)
        if texts is not None:
            return Schema(encoding, _joined(texts, suffix))
    return NO_SCHEMA


def _texts(root: str, suffix: str) -> dict[str, str] | None:
    """Return the definitions of a type and its nested types; None if a file is missing."""
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
    """Concatenate the definitions: the root first, nested types (in IDL all) under their names."""
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
