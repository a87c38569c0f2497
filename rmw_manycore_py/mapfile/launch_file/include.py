# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Included launch files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from typing_extensions import override

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file.actions import (
    Action,
    Condition,
    LaunchDescription,
)
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import perform, text_or_missing

Frontend = Callable[[Path], LaunchDescription]
# Reader by file suffix; filled by `reader`.
FRONTENDS: dict[str, Frontend] = {}
_DEEPEST_INCLUDE = 50
_MAX_FILES = 1000


class LaunchDescriptionSource:
    """Path of a launch file; its suffix selects the reader."""

    def __init__(self, launch_file_path: Any) -> None:
        self.launch_file_path = launch_file_path


class IncludeLaunchDescription(Action):
    """`include`."""

    def __init__(
        self,
        launch_description_source: Any,
        *,
        launch_arguments: Iterable[tuple[Any, Any]] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.source = launch_description_source
        self.launch_arguments = list(launch_arguments or ())

    @override
    def execute(self, context: LaunchContext) -> None:
        source = self.source
        path = source.launch_file_path if isinstance(source, LaunchDescriptionSource) else source
        if isinstance(path, LaunchDescription):
            self._set_arguments(context)
            path.visit(context)
            return
        file = Path(perform(context, path))
        if not os.path.isfile(file):
            raise LaunchFileError("an existing launch file", str(file))
        self._set_arguments(context)
        read_into(context, file)

    def _set_arguments(self, context: LaunchContext) -> None:
        for name, value in self.launch_arguments:
            key = perform(context, name)
            context.launch_configurations[key] = text_or_missing(context, value)


def read_into(context: LaunchContext, file: Path) -> None:
    """Read a launch file and record what it starts."""
    context.depth += 1
    context.files += 1
    if context.depth > _DEEPEST_INCLUDE:
        raise LaunchFileError("launch files that do not include themselves", str(file))
    if context.files > _MAX_FILES:
        raise LaunchFileError(f"at most {_MAX_FILES} launch files, each include counted", str(file))
    frontend = next(
        (read for suffix, read in FRONTENDS.items() if file.name.endswith(suffix)), None
    )
    if frontend is None:
        problem = Problem(file, 0, "", f"a file ending in {', '.join(FRONTENDS)}", f"'{file.name}'")
        raise MapfileError(problem)
    try:
        with context.reading(file):
            frontend(file).visit(context)
    finally:
        context.depth -= 1
