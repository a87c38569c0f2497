# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles installed with rmw_manycore, by name."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.ros import ament

SUFFIXES = (".yaml", ".map")  # in order of precedence
_PARAMETER_FILE = ".params.yaml"
_COMMENT = "# "
_LICENCE = "SPDX-License-Identifier"


def installed_mapfiles() -> dict[str, Path]:
    """Return the installed mapfiles by stem, or by file name if the stem is taken."""
    share = ament.package_share("rmw_manycore")
    found: dict[str, Path] = {}
    for suffix in SUFFIXES:
        for file in sorted(share.glob(f"mapfiles/*{suffix}")) if share else ():
            if not file.name.endswith(_PARAMETER_FILE):
                found[file.name if file.stem in found else file.stem] = file
    return dict(sorted(found.items()))


def find_mapfile(name: str) -> Path | None:
    """Return a file of the working directory, else an installed one; the suffix is optional."""
    names = [name, *(f"{name}{suffix}" for suffix in SUFFIXES)]
    here = (Path(file) for file in names if Path(file).exists() and not Path(file).is_dir())
    known = installed_mapfiles()
    by_file = {file.name: file for file in known.values()}
    return next(here, known.get(name) or by_file.get(name))


def description(mapfile: Path) -> str:
    """Return the first comment of a mapfile."""
    lines = []
    for line in mapfile.read_text(encoding="utf-8").splitlines():
        if not line.startswith(_COMMENT):
            break
        if _LICENCE not in line:
            lines.append(line.removeprefix(_COMMENT))
    return " ".join(lines)
