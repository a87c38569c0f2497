# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles without private data: last path components only, and no values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from rmw_manycore_py.cli.doctor.report.environment import is_shown
from rmw_manycore_py.errors import ManycoreError

_HIDDEN = "(not shown)"
_OPTIONS_WITH_VALUES = ("--duration", "--node")


def mapfiles(given: str | None) -> list[dict[str, Any]] | str:
    """Return the given mapfile, else those of this user's runs."""
    paths = [_found(Path(), given)] if given else list(_running())
    rows = [{"file": path.name, "content": _shown(path)} for path in paths]
    return rows or "no run is in progress"


def _shown(path: Path) -> Any:
    from rmw_manycore_py.mapfile import load_mapfile

    try:
        mapfile = load_mapfile(path)
    except ManycoreError as error:
        return f"refused: {error}".replace(f"{path.parent}/", "")
    sections = mapfile.sections.model_dump(mode="json", exclude_defaults=True)
    if launch_path := sections.get("launch_path"):
        sections["launch_path"] = Path(launch_path).name
    for node in sections.get("nodes", {}).values():
        _hide_values(node)
    return sections


def _hide_values(node: dict[str, Any]) -> None:
    """Keep only what describes placement and connections in a node's section."""
    env = node.get("env", {})
    hidden = {name: value if is_shown(name) else _HIDDEN for name, value in env.items()}
    parameters = dict.fromkeys(node.get("parameters", {}), _HIDDEN)
    values: Mapping[str, Any] = {
        "env": hidden,
        "parameters": parameters,
        "arguments": f"({len(node.get('arguments', ()))}, not shown)",
        "param_file": [Path(file).name for file in node.get("param_file", ())],
        "script": Path(node.get("script", "")).name,
        "command": [Path(word).name for word in node.get("command", ())[:1]],
    }
    node.update({key: value for key, value in values.items() if key in node})


def _running() -> Iterator[Path]:
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # another user's process, or ended
            words = (process / "cmdline").read_bytes().decode(errors="replace").split("\0")
            name = mapfile_of(words)
            if name is not None:
                yield _found((process / "cwd").resolve(), name)


def mapfile_of(words: list[str]) -> str | None:
    """Return the mapfile in the command line of a `manycore run`; None for other programs."""
    names = [Path(word).name for word in words]
    if "manycore" not in names[:2]:
        return None
    if words[names.index("manycore") + 1 :][:1] not in (["run"], ["up"]):
        return None
    rest = iter(words[names.index("manycore") + 2 :])
    for word in rest:
        if word in _OPTIONS_WITH_VALUES:
            next(rest, None)
        elif word and not word.startswith("-"):
            return word
    return None


def _found(directory: Path, name: str) -> Path:
    from rmw_manycore_py.mapfile.installed import find_mapfile

    path = directory / name
    return path if path.is_file() else find_mapfile(name) or path
