# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Routes across the border of a platform: topics, services, and the parts of actions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from rmw_manycore_py.ros.patterns import is_pattern, matches
from rmw_manycore_py.ros.qos import Policies

# Paper terms: topic_in and service_in are inward, topic_to and service_to outward.
Direction = Literal["inward", "outward"]
DIRECTIONS: tuple[Direction, Direction] = ("inward", "outward")

# Default request timeout.
REQUEST_TIMEOUT_S = 60.0


@dataclass(frozen=True)
class Route:
    """One topic or service. A service is inward if its server is on the platform.

    `qos` overrides policies of a topic. `timeout_s` is the request timeout; None waits as long as
    the server exists. A `mirrored` topic is bridged in both directions, so the bridge has to
    recognise its own messages. An `eager` topic is subscribed as soon as a publisher exists: the
    first messages of an action must not wait for a subscriber. `node` is the full external name of
    the node that offers a service, for tools that look up the node first. The external names of a
    pattern's topics differ by `prefix`.
    """

    kind: Literal["topic", "service"]
    direction: Direction
    inside: str
    outside: str
    type: str
    domain: int
    qos: Policies = field(default_factory=Policies)
    max_hz: float | None = None
    max_size: int | None = None
    timeout_s: float | None = REQUEST_TIMEOUT_S
    mirrored: bool = False
    eager: bool = False
    lane: int = 0
    node: str | None = None
    prefix: str = ""

    @property
    def is_pattern(self) -> bool:
        """Whether the route matches all topics of a pattern."""
        return is_pattern(self.inside)


def action_routes(action: Route) -> Iterator[Route]:
    """Yield the parts of an action, given like a service: goals go in its direction."""
    back: Direction = "outward" if action.direction == "inward" else "inward"
    parts = (
        ("service", "send_goal", f"{action.type}_SendGoal", action.timeout_s),
        ("service", "cancel_goal", "action_msgs/srv/CancelGoal", action.timeout_s),
        ("service", "get_result", f"{action.type}_GetResult", None),  # takes as long as the goal
        ("topic", "feedback", f"{action.type}_FeedbackMessage", None),
        ("topic", "status", "action_msgs/msg/GoalStatusArray", None),
    )
    for kind, name, type_name, timeout_s in parts:
        yield replace(
            action,
            kind=kind,  # type: ignore[arg-type]
            direction=action.direction if kind == "service" else back,
            inside=f"{action.inside}/_action/{name}",
            outside=f"{action.outside}/_action/{name}",
            type=type_name,
            timeout_s=timeout_s,
            eager=kind == "topic",
        )


def parameter_routes(node: Route) -> Iterator[Route]:
    """Yield the parameter services of a node, given as a route with the node's full names."""
    services = {
        "describe_parameters": "DescribeParameters",
        "get_parameters": "GetParameters",
        "get_parameter_types": "GetParameterTypes",
        "list_parameters": "ListParameters",
        "set_parameters": "SetParameters",
        "set_parameters_atomically": "SetParametersAtomically",
    }
    for name, type_name in services.items():
        yield replace(
            node,
            kind="service",
            direction="inward",
            inside=f"{node.inside}/{name}",
            outside=f"{node.outside}/{name}",
            type=f"rcl_interfaces/srv/{type_name}",
            node=node.outside,
        )


def arranged(routes: Iterable[Route], lanes: int) -> tuple[Route, ...]:
    """Return each route once, distributed over the lanes; mark those bridged in both directions."""
    unique = list({_key(route): route for route in routes}.values())
    ways = {(r.inside, r.direction) for r in unique} | {
        ((r.outside, r.domain), r.direction) for r in unique
    }
    numbers = dict.fromkeys(DIRECTIONS, 0)
    of_nodes: dict[str, int] = {}  # services of one external node share a lane
    result = []
    for route in unique:
        back = "outward" if route.direction == "inward" else "inward"
        mirrored = (route.inside, back) in ways or ((route.outside, route.domain), back) in ways
        mirrored = mirrored or any(
            matches(other.inside, route.inside)
            for other in unique
            if other.is_pattern and other.direction == back
        )
        lane = numbers[route.direction] % lanes
        if route.node is not None:
            lane = of_nodes.setdefault(route.node, lane)
        numbers[route.direction] += 1
        result.append(replace(route, mirrored=mirrored, lane=lane))
    return tuple(result)


def _key(route: Route) -> tuple[Any, ...]:
    return (route.kind, route.direction, route.inside, route.outside, route.domain)
