# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Zenoh session of a bridge process, configured as rmw_zenoh configures its own."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Any

import zenoh

DEFAULT_CONNECT = ("tcp/localhost:7447",)
CONFIG_FILE = "ZENOH_SESSION_CONFIG_URI"  # the variable that rmw_zenoh reads
_SETTINGS: dict[str, Any] = {
    "mode": "peer",
    # Peers of this host connect directly; those of other hosts go through the router.
    "listen/endpoints": ["tcp/localhost:0"],
    "scouting/multicast/enabled": False,
    # Go on without a router, and connect once there is one.
    "connect/timeout_ms": -1,
    "connect/exit_on_failure": False,
}


def open_session(connect: Sequence[str]) -> zenoh.Session:
    """Open a session that connects to routers or peers, as soon as they are there."""
    path = os.environ.get(CONFIG_FILE)
    if path:
        config = zenoh.Config.from_file(path)
    else:
        config = zenoh.Config()
        for key, value in _SETTINGS.items():
            config.insert_json5(key, json.dumps(value))
    if connect or not path:
        config.insert_json5("connect/endpoints", json.dumps([*(connect or DEFAULT_CONNECT)]))
    return zenoh.open(config)
