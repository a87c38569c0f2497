# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profile files: JSON, with one line per callback, publisher and so on."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from rmw_manycore_py.errors import FileError, ManycoreError, Problem, invalid_field
from rmw_manycore_py.profile.consistency import misfits_of
from rmw_manycore_py.profile.model import FORMAT, VERSION, Profile
from rmw_manycore_py.trace.atomic_file import atomic_write


class _Head(BaseModel):
    """What a file of any version has."""

    format: str
    version: int


def save(profile: Profile, path: Path) -> None:
    """Write a profile. Replaces an existing file only when complete.

    :raises ManycoreError: if the file cannot be written.
    """
    try:
        with atomic_write(path) as file:
            file.write(to_text(profile).encode())
            os.fchmod(file.fileno(), 0o666 & ~_umask())
    except OSError as error:
        raise ManycoreError(f"{path}: cannot be written: {error.strerror or error}") from error


def load(path: Path) -> Profile:
    """Read a profile.

    :raises ManycoreError: if it cannot be read; FileError if it is no profile.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ManycoreError(f"{path}: cannot be read: {error.strerror or error}") from error
    try:
        head = _Head.model_validate_json(content)
        if (head.format, head.version) != (FORMAT, VERSION):
            raise _problem(path, "version", str(VERSION), f"{head.version} of {head.format}")
        profile = Profile.model_validate_json(content)
    except ValidationError as error:
        key, found = invalid_field(error)
        raise _problem(path, key, "the profile of an application", found) from error
    for misfit in misfits_of(profile):
        raise _problem(path, *misfit)
    return profile


def _problem(path: Path, key: str, expected: str, found: str) -> FileError:
    return FileError(Problem(path, 0, key, expected, found))


def to_text(profile: Profile) -> str:
    """Return the content of a profile's file."""
    sections = [f'"{key}": {_section(value)}' for key, value in profile.model_dump().items()]
    return "{\n" + ",\n".join(sections) + "\n}\n"


def _section(value: Any) -> str:
    if isinstance(value, tuple) and value and isinstance(value[0], dict):
        rows = ",\n".join(json.dumps(row, separators=(",", ":")) for row in value)
        return f"[\n{rows}\n]"
    return json.dumps(value)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
