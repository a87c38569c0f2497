# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapfile bridges to the outside, and where the bridge runs."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, Any, cast

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.model import (
    BridgeSection,
    NodeSection,
    QosSection,
    RouteSection,
)
from rmw_manycore_py.mapfile.placing.placement import BridgePlacement
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.ros.domain import ros_domain
from rmw_manycore_py.ros.names import expand
from rmw_manycore_py.ros.patterns import is_pattern
from rmw_manycore_py.ros.qos import Policies
from rmw_manycore_py.routes.hosts import host_routes
from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.route import (
    REQUEST_TIMEOUT_S,
    Direction,
    Route,
    action_routes,
    arranged,
    parameter_routes,
)

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile
    from rmw_manycore_py.mapfile.placing.start import NodeStart

# Keys of a node that define routes.
CROSSINGS: dict[str, Direction] = {
    "topic_in": "inward",
    "topic_to": "outward",
    "service_in": "inward",
    "service_to": "outward",
    "action_in": "inward",
    "action_to": "outward",
}

# Route keys that apply to one kind only; an action is both.
ONLY_OF = {"max_hz": "topic", "max_size": "topic", "qos": "topic", "timeout": "service"}


def bridge_placement(
    mapfile: Mapfile, starts: dict[str, NodeStart], used: Collection[Core]
) -> BridgePlacement | None:
    """Return the routes, and the first free cores of the bridge's cluster, two per lane."""
    bridge = mapfile.sections.bridge
    routes: list[Route] = []
    for name, node in mapfile.sections.nodes.items():
        routes += _routes_of(bridge, node, starts[name])
    _check_routes(mapfile, routes)
    if not routes:
        return None
    placed = arranged(routes, bridge.lanes)
    lanes = _lanes(mapfile, used, bridge.lanes)
    return BridgePlacement(placed, lanes, bridge.host_cpu or (), bridge.outside.settings)


def links_placement(mapfile: Mapfile, used: Collection[Core]) -> tuple[BridgePlacement, ...]:
    """Return what joins this host's part of a platform with the parts of other hosts.

    The first is inward, the others are outward, one for each host.
    """
    if mapfile.host is None:
        return ()
    addresses = {name: host.address for name, host in mapfile.sections.hosts.items()}
    own = OutsideSettings("hosts", listen=addresses.pop(mapfile.host), host=mapfile.host)
    outward = (replace(own, connect=(there,), peer=peer) for peer, there in addresses.items())
    cores = chain(*_lanes(mapfile, used, len(addresses)))  # each has one process
    return tuple(
        BridgePlacement(host_routes("outward" if one.peer else "inward"), ((core, core),), (), one)
        for one, core in zip((own, *outward), cores, strict=False)
    )


def _lanes(mapfile: Mapfile, used: Collection[Core], count: int) -> tuple[tuple[Core, Core], ...]:
    cluster = mapfile.topology.clusters[mapfile.home_cluster - 1]
    places = [Core(cluster.id, core) for core in cluster.free]
    free = [core for core in places if core not in used]
    # If all cores are taken, the processes share the last one.
    cores = [*free, *[places[-1]] * 2 * count]
    return tuple((cores[2 * i], cores[2 * i + 1]) for i in range(count))


def _routes_of(bridge: BridgeSection, node: NodeSection, start: NodeStart) -> Iterator[Route]:
    for key, direction in CROSSINGS.items():
        for name, type_name in getattr(node, key).items():
            inside = start.topic(name)
            route = _route(bridge, inside, type_name, direction)
            yield from action_routes(route) if key.startswith("action") else (route,)
    if node.parameters_in:
        yield from parameter_routes(_route(bridge, start.full_name, "", "inward"))


def _route(
    bridge: BridgeSection, inside: str, type_name: str | None, direction: Direction
) -> Route:
    section = _section_of(bridge, inside)
    domain = section.domain if section.domain is not None else bridge.domain
    prefix = expand((bridge.prefix or "").rstrip("/"), "/") if bridge.prefix else ""
    outside = section.name or f"{prefix}{inside}"
    return Route(
        kind="topic" if type_name is None or "/msg/" in type_name else "service",
        direction=direction,
        inside=inside,
        outside=expand(outside, "/"),
        type=type_name or "",
        domain=ros_domain() if domain is None else domain,
        qos=overrides(section.qos),
        max_hz=section.max_hz,
        max_size=section.max_size,
        timeout_s=section.timeout or REQUEST_TIMEOUT_S,
        prefix=prefix if is_pattern(inside) else "",
    )


def _section_of(bridge: BridgeSection, inside: str) -> RouteSection:
    named = {expand(name, "/"): section for name, section in bridge.routes.items()}
    return named.get(inside, RouteSection())


def _check_routes(mapfile: Mapfile, routes: list[Route]) -> None:
    """Raise MapfileError for settings of routes that do not exist."""
    crossing: dict[str, set[str]] = {}
    for route in routes:
        crossing.setdefault(_written_as(route), set()).add(route.kind)
    problems = []
    for name, section in mapfile.sections.bridge.routes.items():
        path, kinds = ("bridge", "routes", name), crossing.get(expand(name, "/"))
        if kinds is None:
            known = ", ".join(sorted(crossing)) or "nothing does"
            expected = f"the name of something that crosses ({known})"
            problems.append(mapfile.document.problem(path, expected, f"'{name}'"))
            continue
        for key in sorted(section.model_fields_set):
            if key == "name" and is_pattern(name):
                expected = "no name: topics of a pattern keep theirs, behind the bridge's prefix"
                problems.append(
                    mapfile.document.problem((*path, key), expected, f"'{section.name}'")
                )
            elif (kind := ONLY_OF.get(key, next(iter(kinds)))) not in kinds:
                expected = f"a key of a {next(iter(kinds))}"
                found = f"'{key}', which is for a {kind}"
                problems.append(mapfile.document.problem((*path, key), expected, found))
    if problems:
        raise MapfileError(*problems)


def _written_as(route: Route) -> str:
    """Return the name by which the mapfile knows a route; for actions and nodes, their own name."""
    if "/_action/" in route.inside:
        return route.inside.rpartition("/_action/")[0]
    return route.inside.rpartition("/")[0] if route.node is not None else route.inside


def overrides(qos: QosSection) -> Policies:
    """Return the policies that are set."""
    found: dict[str, Any] = {
        key: getattr(qos, key)
        for key in ("reliability", "durability", "history", "depth")
        if getattr(qos, key) is not None
    }
    if qos.liveliness not in (None, "system_default"):
        found["liveliness"] = qos.liveliness
    times = {
        "deadline_ns": qos.deadline,
        "lifespan_ns": qos.lifespan,
        "liveliness_lease_ns": qos.liveliness_lease_duration,
    }
    for key, value in times.items():
        if isinstance(value, int):
            found[key] = value if value > 0 else None
    return cast(Policies, found)
