# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which engine a bridge uses outside, and where it connects to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rmw_manycore_py.routes.route import Direction

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
    """

    engine: EngineName | LinkName = _DEFAULT
    connect: tuple[str, ...] = ()
    listen: str = ""
    host: str = ""

    @property
    def title(self) -> str:
        """What its processes are called."""
        return self.engine if self.engine == "hosts" else "bridge"

    def stem(self, direction: Direction) -> str:
        """Return what the names of files and nodes of its processes have in common.

        >>> OutsideSettings("zenoh").stem("inward")
        'zenoh_inward'
        """
        return direction if self.engine == _DEFAULT else f"{self.engine}_{direction}"


def engine_of(stem: str) -> str:
    """Return the engine of a stem."""
    return stem.rpartition("_")[0] or _DEFAULT
