# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes as a person names them."""

from __future__ import annotations

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.errors import ManycoreError


def absolute_name(name: str) -> str:
    """Return a node's full name; the slash in front may be left out."""
    return name if name.startswith("/") else f"/{name}"


def existing_node(platform: str, name: str) -> str:
    """Return the full name of a node that is there."""
    full_name = absolute_name(name)
    with view.open_platform(platform) as opened:
        names = view.node_names(opened.nodes(), hidden=True)
    if full_name not in names:
        raise ManycoreError(f"unable to find node '{full_name}' (manycore node list shows all)")
    return full_name


def nodes_with_service(platform: str, service: str, type_name: str) -> list[str]:
    """Return the nodes that serve `service` of that type below their own name."""
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
