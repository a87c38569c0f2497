# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A mapfile on the command line: a path, or the name of an installed one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.mapfile.installed import SUFFIXES, find_mapfile, installed_mapfiles


def mapfile_argument(metavar: str = "MAPFILE", default: str | None = None) -> Callable[[Any], Any]:
    """Return the argument `mapfile`; optional if there is a default."""
    # click 8.3 takes `default=None` for a value that was given.
    optional: dict[str, Any] = {} if default is None else {"default": default}
    return click.argument(
        "mapfile",
        metavar=metavar,
        required=default is None,
        callback=_find,
        shell_complete=_complete,
        **optional,
    )


def _find(_context: click.Context, _argument: click.Parameter, name: str) -> Path:
    found = find_mapfile(name)
    if found is None:
        known = installed_mapfiles()
        names = ", ".join(known) or "none"
        meant = did_you_mean(name, known)
        raise click.BadParameter(f"There is no file '{name}'; installed mapfiles: {names}{meant}")
    return found


def _complete(
    _context: click.Context, _parameter: click.Parameter, incomplete: str
) -> list[CompletionItem[str]]:
    """Offer installed mapfiles and those in the working directory; paths are left to the shell."""
    here = (file.name for suffix in SUFFIXES for file in Path().glob(f"*{suffix}"))
    names = sorted({*installed_mapfiles(), *here})
    found = [CompletionItem(name) for name in names if name.startswith(incomplete)]
    return found or [CompletionItem(incomplete, type="file")]
