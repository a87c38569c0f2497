# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Resolve node names given on the command line."""

from __future__ import annotations

import time

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean

_LOOK_S = 0.1


def absolute_name(name: str) -> str:
    """Return the fully qualified name of a node; the leading slash is optional in `name`."""
    return name if name.startswith("/") else f"/{name}"


def existing_node(
    platform: str, name: str, timeout_s: float = 0.0, missing: str = "Unable to find node"
) -> str:
    """Return the full name of a node, waiting for it up to the timeout.

    :param timeout_s: negative waits forever.
    :param missing: start of the error message; ros2cli words it differently for each verb.
    :raises ManycoreError: if the node does not appear in time.
    """
    wanted = absolute_name(name)
    end_s = time.monotonic() + timeout_s if timeout_s >= 0 else float("inf")
    while True:
        is_last_look = time.monotonic() >= end_s
        names = _names_on(platform, may_lack=not is_last_look)
        if wanted in names:
            return wanted
        if is_last_look:
            meant = did_you_mean(wanted, names) or " (`manycore node list` shows all)"
            raise ManycoreError(f"{missing} '{wanted}'{meant}")
        time.sleep(_LOOK_S)


def _names_on(platform: str, *, may_lack: bool) -> list[str]:
    """Return the nodes of a platform; with `may_lack`, none if the platform does not exist."""
    if may_lack and platform not in view.platform_names():
        return []
    with view.open_platform(platform) as opened:
        return view.node_names(opened.nodes(), hidden=True)


def nodes_with_service(platform: str, service: str, type_name: str) -> list[str]:
    """Return the nodes that offer `service` of that type below their own name."""
    with view.open_platform(platform) as opened:
        endpoints, nodes = opened.endpoints(), opened.nodes()
    served = {
        endpoint.topic
        for endpoint in endpoints
        if (endpoint.role, endpoint.kind) == ("request", "subscription")
        and endpoint.type == type_name
    }
    names = view.node_names(nodes, hidden=True)
    return [name for name in names if f"{name}/{service}" in served]
