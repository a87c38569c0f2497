# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Routes between the hosts of one platform: every topic and service, each under its own name."""

from __future__ import annotations

from typing import Literal

from rmw_manycore_py.routes.route import Direction, Route, arranged

_DOMAIN = 0  # the addresses tell the hosts of one platform from others
_KINDS: tuple[Literal["topic"], Literal["service"]] = ("topic", "service")
_ALL, _PARTS_OF_ACTIONS = "/**", "/**/_action/*"


def host_routes(direction: Direction) -> tuple[Route, ...]:
    """Return the routes of a host, from all others or to one.

    As on one host, a request waits as long as its server exists.
    """
    return arranged(
        (
            Route(
                kind=kind,
                direction=direction,
                inside=pattern,
                outside=pattern,
                type="",
                domain=_DOMAIN,
                timeout_s=None,
                eager=(kind, pattern) == ("topic", _PARTS_OF_ACTIONS),
            )
            for kind in _KINDS
            for pattern in (_ALL, _PARTS_OF_ACTIONS)
        ),
        lanes=1,
    )
