# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which engine a bridge uses outside, and where it connects to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from rmw_manycore_py.routes.route import DIRECTIONS, Direction

# What a mapfile can name; `hosts` joins the parts of a platform that has several hosts.
EngineName = Literal["fastdds", "zenoh"]
LinkName = Literal["hosts"]
_DEFAULT: EngineName = "fastdds"


@dataclass(frozen=True)
class OutsideSettings:
    """The outside of one bridge; a platform has at most one bridge of each engine.

    :ivar connect: locators of zenoh routers or peers, as tcp/localhost:7447.
    :ivar listen: of `hosts`, the locator at which this host listens.
    :ivar host: of `hosts`, the name of this one.
    :ivar peer: of `hosts`, the host that an outward process connects to.
    """

    engine: EngineName | LinkName = _DEFAULT
    connect: tuple[str, ...] = ()
    listen: str = ""
    host: str = ""
    peer: str = ""

    def title(self, direction: Direction) -> str:
        """Return what its processes are called.

        >>> OutsideSettings("hosts", peer="b").title("outward")
        'hosts outward b'
        """
        name = self.engine if self.engine == "hosts" else "bridge"
        return " ".join(filter(None, (name, direction, self.peer)))

    def stem(self, direction: Direction) -> str:
        """Return what the names of files and nodes of its processes have in common.

        >>> OutsideSettings("hosts", peer="b").stem("outward")
        'hosts_outward_b'
        """
        engine = "" if self.engine == _DEFAULT else self.engine
        return "_".join(filter(None, (engine, direction, self.peer)))

    def stems(self) -> list[str]:
        """Return what the stems of all its processes begin with."""
        return [replace(self, peer="").stem(direction) for direction in DIRECTIONS]


def engine_and_peer(stem: str) -> tuple[str, str]:
    """Return the engine of a stem, and the host that it leads to, if any.

    >>> engine_and_peer("hosts_outward_b")
    ('hosts', 'b')
    """
    engine, _, rest = stem.rpartition("_") if stem in DIRECTIONS else stem.partition("_")
    return engine or _DEFAULT, rest.partition("_")[2]
