# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Registries of this user's platforms, and the libraries their processes have loaded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rmw_manycore_py.cli.doctor.report.environment import short_path
from rmw_manycore_py.errors import what_is_wrong

_MIDDLEWARES = ("librmw_", "libfastrtps.", "libfastdds.")


def platforms() -> list[dict[str, Any]]:
    """Return the contents of each platform, or why it cannot be read."""
    from rmw_manycore_py.cli.common.view import platform_names

    return [_readable(name) for name in platform_names()]


def _readable(name: str) -> dict[str, Any]:
    try:
        return _snapshot(name)
    except Exception as error:  # report a damaged platform, keep the others
        return {"name": name, "not available": what_is_wrong(error)}


def _snapshot(name: str) -> dict[str, Any]:
    from rmw_manycore_py.cli.common import rows, view
    from rmw_manycore_py.ros.names import node_names_by_process

    with view.open_platform(name) as opened:
        endpoints, nodes = opened.endpoints(), node_names_by_process(opened.nodes())
        return {
            **rows.platform_row(opened.info()),
            "clusters": [rows.cluster_row(cluster) for cluster in opened.clusters()],
            "processes": [
                {
                    **rows.process_row(process),
                    "nodes": nodes[process.slot],
                    "middleware loaded": _loaded(process.pid),
                }
                for process in opened.processes()
            ],
            "endpoints": [rows.endpoint_row(endpoint) for endpoint in endpoints],
            "losses": view.losses(endpoints),
        }


def _loaded(pid: int) -> list[str] | str:
    """Return the middleware libraries a process has loaded; a stand-in lies in standin/."""
    try:
        lines = Path(f"/proc/{pid}/maps").read_text(errors="replace").splitlines()
    except OSError as error:
        return f"not readable: {error.strerror}"
    files = {line.split(maxsplit=5)[5] for line in lines if line.count("/")}
    named = (file for file in files if Path(file).name.startswith(_MIDDLEWARES))
    return sorted(map(short_path, named)) or "none"
