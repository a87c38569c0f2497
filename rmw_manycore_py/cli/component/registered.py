# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The component types that packages register in the ament index."""

from __future__ import annotations

from rmw_manycore_py.ros import ament

RESOURCE = "rclcpp_components"


def packages_with_components() -> list[str]:
    """Return the packages that register component types."""
    return ament.resource_names(RESOURCE)


def component_types(package: str) -> list[str]:
    """Return the component types of a package, in the order in which it registers them."""
    found = ament.find_resource(RESOURCE, package) if package else None
    if found is None:
        return []
    lines = found[1].read_text().splitlines()
    return [line.partition(";")[0] for line in lines if line.strip()]
