# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A mapfile on the command line: a path, or the name of an installed one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.mapfile.installed import find_mapfile, installed_mapfiles


def mapfile_argument(metavar: str = "MAPFILE", default: str | None = None) -> Callable[[Any], Any]:
    """Return the argument `mapfile`; it may be left out where there is a default."""
    return click.argument(
        "mapfile", metavar=metavar, default=default, required=default is None, callback=_find
    )


def _find(_context: click.Context, _argument: click.Parameter, name: str) -> Path:
    found = find_mapfile(name)
    if found is None:
        known = ", ".join(installed_mapfiles()) or "none"
        raise click.BadParameter(f"There is no file '{name}'; installed mapfiles: {known}.")
    return found
