# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The engines that a bridge can have outside; each is loaded only where it is used."""

from __future__ import annotations

from importlib import import_module

from rmw_manycore_bridge.outside.interface import Outside
from rmw_manycore_py.routes.outside import EngineName, LinkName

_CLASSES: dict[EngineName | LinkName, str] = {
    "fastdds": "rmw_manycore_bridge.fastdds.outside:FastDds",
    "hosts": "rmw_manycore_bridge.zenoh.hosts:Hosts",
    "zenoh": "rmw_manycore_bridge.zenoh.outside:Zenoh",
}


def load_engine(name: EngineName | LinkName) -> type[Outside]:
    """Return the class of an engine."""
    module, _, class_name = _CLASSES[name].partition(":")
    found: type[Outside] = getattr(import_module(module), class_name)
    return found
