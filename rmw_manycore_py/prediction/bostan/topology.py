# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The 32 nodes of the data NoC and their links (thesis, Fig. 2.3).

```
            N0  N1  N2  N3           four nodes per I/O subsystem: N, S, W, E
        W0  C1  C2  C3  C4  E0       16 compute clusters, numbered row by row
        W1  C5  C6  C7  C8  E1
        W2  C9  C10 C11 C12 E2       rings: each column with its N and S node,
        W3  C13 C14 C15 C16 E3       each row with its W and E node
            S0  S1  S2  S3
```
"""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

SIDE = 4
CLUSTERS = SIDE * SIDE
SUBSYSTEMS = "NSWE"

Node = str
Hop = tuple[Node, Node]


def cluster(number: int) -> Node:
    """Return the node of a compute cluster, counted from 1.

    :raises ManycoreError: when the chip has no such cluster.
    """
    if not 1 <= number <= CLUSTERS:
        message = f"cluster {number}: expected 1 to {CLUSTERS}, the compute clusters of Bostan"
        raise ManycoreError(message, EXIT_BAD_INPUT)
    return f"C{number}"


def io_node(subsystem: str, number: int) -> Node:
    """Return a node of an I/O subsystem, counted from 0.

    :raises ManycoreError: when the chip has no such node.
    """
    if subsystem not in tuple(SUBSYSTEMS) or not 0 <= number < SIDE:
        expected = f"N, S, W or E with 0 to {SIDE - 1}"
        message = f"I/O node {subsystem}{number}: expected {expected}"
        raise ManycoreError(message, EXIT_BAD_INPUT)
    return f"{subsystem}{number}"


def column(index: int) -> list[Node]:
    """Return the ring of a column, from north to south."""
    inner = [cluster(row * SIDE + index + 1) for row in range(SIDE)]
    return [io_node("N", index), *inner, io_node("S", index)]


def row(index: int) -> list[Node]:
    """Return the ring of a row, from west to east."""
    inner = [cluster(index * SIDE + place + 1) for place in range(SIDE)]
    return [io_node("W", index), *inner, io_node("E", index)]


def nodes() -> list[Node]:
    """Return all nodes."""
    inner = [cluster(number) for number in range(1, CLUSTERS + 1)]
    return inner + [io_node(side, number) for side in SUBSYSTEMS for number in range(SIDE)]


def hops() -> set[Hop]:
    """Return every link, in both of its directions."""
    found = set()
    for ring in _rings():
        for one, other in zip(ring, [*ring[1:], ring[0]], strict=True):
            found |= {(one, other), (other, one)}
    return found


def _rings() -> Iterator[list[Node]]:
    for index in range(SIDE):
        yield column(index)
        yield row(index)
