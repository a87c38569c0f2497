# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Source routes: the sender lists the nodes that a packet passes.

`shortest` goes along its row first and then along its column, as far as both ends allow, and never
over the links that close a ring: no cycle of links can wait for each other. The thesis' other
routes are lists that it draws (Fig. 4.1).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.prediction.bostan import topology
from rmw_manycore_py.prediction.bostan.topology import SIDE, Hop, Node

Route = tuple[Node, ...]

_HOPS = frozenset(topology.hops())


def checked(route: Sequence[Node]) -> Route:
    """Return the route.

    :raises ManycoreError: when two nodes that follow each other have no link, or it is no route.
    """
    if len(route) < 2:
        raise ManycoreError("a route needs two nodes or more", EXIT_BAD_INPUT)
    for hop in hops_of(route):
        if hop not in _HOPS:
            message = f"the route {' '.join(route)}: there is no link from {hop[0]} to {hop[1]}"
            raise ManycoreError(message, EXIT_BAD_INPUT)
    return tuple(route)


def hops_of(route: Sequence[Node]) -> list[Hop]:
    """Return the links of a route."""
    return list(pairwise(route))


def shortest(source: Node, destination: Node) -> Route:
    """Return the dimension-ordered route.

    An I/O node has one link into the grid, by which routes to it and from it pass.
    """
    entry, first = _inner(source)
    leave, last = _inner(destination)
    between = _in_the_grid(first, last)
    return checked([*entry, *between, *reversed(leave)])


def _inner(node: Node) -> tuple[list[Node], Node]:
    """Return the I/O node itself, if it is one, and the cluster beside it or the cluster."""
    side, number = node[0], int(node[1:])
    if side == "C":
        return [], node
    ring = topology.column(number) if side in "NS" else topology.row(number)
    return [node], ring[1] if side in "NW" else ring[-2]


def _in_the_grid(source: Node, destination: Node) -> list[Node]:
    (from_row, from_column), (to_row, to_column) = _place(source), _place(destination)
    along = [(from_row, c) for c in _steps(from_column, to_column)]
    down = [(r, to_column) for r in _steps(from_row, to_row)[1:]]
    return [topology.cluster(r * SIDE + c + 1) for r, c in along + down]


def _place(node: Node) -> tuple[int, int]:
    return divmod(int(node[1:]) - 1, SIDE)


def _steps(start: int, end: int) -> list[int]:
    step = 1 if end >= start else -1
    return list(range(start, end + step, step))


def can_deadlock(routes: Iterable[Sequence[Node]]) -> bool:
    """Return whether packets on these routes could wait for each other in a circle.

    They can when the links, each followed by the next one of some route, form a cycle (Dally).
    """
    after: dict[Hop, set[Hop]] = {}
    for route in routes:
        hops = hops_of(route)
        for hop, following in pairwise(hops):
            after.setdefault(hop, set()).add(following)
    while after:
        ends = {hop for hop, following in after.items() if not following & after.keys()}
        if not ends:
            return True
        for hop in ends:
            del after[hop]
    return False
