# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Registries of this user's platforms, and the libraries their processes have loaded."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmw_manycore_py.cli.doctor.report.environment import short_path
from rmw_manycore_py.errors import what_is_wrong

if TYPE_CHECKING:
    from rmw_manycore_py.native._transport import EndpointInfo

_MIDDLEWARES = re.compile(r"(librmw_(?!dds_common)|libfastrtps\.|libfastdds\.).*")
_ORDINARY = {"liveliness": "automatic"}


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
            "endpoints": [_line(endpoint) for endpoint in endpoints if endpoint.role == "topic"],
            "endpoints of services": sum(endpoint.role != "topic" for endpoint in endpoints),
            "losses": view.losses(endpoints),
        }


def _line(endpoint: EndpointInfo) -> str:
    """Return an endpoint in one line, with its counters and anything unusual."""
    from rmw_manycore_py.cli.common.rows import counters_row
    from rmw_manycore_py.ros.names import full_node_name
    from rmw_manycore_py.ros.qos import policies_of

    policies = policies_of(endpoint.qos).items()
    kept = [
        f"{name}={value}" if name.endswith("_ns") else str(value)
        for name, value in policies
        if value is not None and _ORDINARY.get(name) != value
    ]
    counts = [f"{name} {count}" for name, count in counters_row(endpoint.counters).items() if count]
    return (
        f"{endpoint.kind} of {endpoint.topic} ({endpoint.type}) by "
        f"{full_node_name(endpoint.node_namespace, endpoint.node_name)}: {' '.join(kept)}; "
        f"{', '.join([endpoint.transfer, f'matched {endpoint.matched}', *counts])}"
    )


def _loaded(pid: int) -> str:
    """Return the middleware libraries a process has loaded; a stand-in lies in standin/."""
    try:
        lines = Path(f"/proc/{pid}/maps").read_text(errors="replace").splitlines()
    except OSError as error:
        return f"not readable: {error.strerror}"
    files = {line.split(maxsplit=5)[5] for line in lines if line.count("/")}
    named = (file for file in files if _MIDDLEWARES.fullmatch(Path(file).name))
    return ", ".join(sorted(map(short_path, named))) or "none"
