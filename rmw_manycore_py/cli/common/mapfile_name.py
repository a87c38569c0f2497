# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles on the command line: a path, or the name of an installed one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from typing_extensions import override

from rmw_manycore_py.mapfile.installed import find_mapfile, installed_mapfiles


class MapfileName(click.ParamType):
    """A file of the working directory wins over an installed one of its name."""

    name = "mapfile"

    @override
    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        if isinstance(value, Path):
            return value
        found = find_mapfile(value)
        if found is None:
            known = ", ".join(installed_mapfiles()) or "none"
            self.fail(f"There is no file '{value}'; installed mapfiles: {known}.", param, ctx)
        return found
