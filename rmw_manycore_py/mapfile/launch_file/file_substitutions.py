# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Substitutions for files, directories and generated names."""

from __future__ import annotations

import os
import tempfile
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_BYTES
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.substitution import Substitution, perform
from rmw_manycore_py.mapfile.launch_file.substitutions import PathJoinSubstitution, default_parts
from rmw_manycore_py.mapfile.launch_file.typed_values import boolean


class PathSubstitution(PathJoinSubstitution):
    """A path that can be extended with `/`."""

    def __init__(self, path: Any) -> None:
        super().__init__([path])


class StringJoinSubstitution(Substitution):
    """Joins its parts with a delimiter."""

    def __init__(self, substitutions: Any, delimiter: Any = "") -> None:
        self.substitutions, self.delimiter = list(substitutions), delimiter

    @override
    def perform(self, context: LaunchContext) -> str:
        parts = (perform(context, part) for part in self.substitutions)
        return perform(context, self.delimiter).join(parts)


class FileContent(Substitution):
    """`$(file-content path)`."""

    def __init__(self, path: Any) -> None:
        self.path = path

    @override
    def perform(self, context: LaunchContext) -> str:
        path = perform(context, self.path)
        try:
            with open(path, encoding="utf-8") as file:
                content = file.read(MAX_BYTES + 1)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "it is no text"
            raise UnavailableError("a readable file", f"'{path}': {reason}") from error
        if len(content) > MAX_BYTES:
            raise LaunchFileError(f"a file of at most {MAX_BYTES} characters", f"'{path}'")
        return content


class LaunchLogDir(Substitution):
    """`$(launch_log_dir)`: the directory of temporary files; `manycore run` has no such logs."""

    @override
    def perform(self, context: LaunchContext) -> str:
        return os.environ.get("ROS_LOG_DIR", tempfile.gettempdir())


class AnonName(Substitution):
    """`$(anon name)`: a name with a numeric suffix, deterministic so that mapfiles can use it."""

    def __init__(self, name: Any) -> None:
        self.name = name

    @override
    def perform(self, context: LaunchContext) -> str:
        return f"{perform(context, self.name)}_1"


class BooleanSubstitution(Substitution):
    """`true` or `false` as text."""

    def __init__(self, value: Any) -> None:
        self.value = value

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(boolean(context, self.value)).lower()


class LocalSubstitution(Substitution):
    """Values that launch only knows while it handles an event."""

    def __init__(self, expression: str, description: str = "") -> None:
        super().__init__()
        self.expression, self.description = expression, description

    @override
    def perform(self, context: LaunchContext) -> str:
        raise LaunchFileError("a text that is known before anything runs", f"'{self.expression}'")


class Parameter(Substitution):
    """`$(param name)`: a parameter set for all later nodes."""

    def __init__(self, name: Any, *, default: Any = None) -> None:
        self.name, self.default = name, default

    @override
    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        for source in context.settings.parameters:
            if isinstance(source, dict) and name in source:
                return str(source[name])
        if self.default is None:
            raise LaunchFileError("a parameter that 'set_parameter' has set", f"'{name}'")
        return perform(context, default_parts(self.default))
