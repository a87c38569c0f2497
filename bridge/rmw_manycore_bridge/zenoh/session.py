# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Zenoh sessions of bridge processes."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any

import zenoh

DEFAULT_CONNECT = ("tcp/localhost:7447",)
CONFIG_FILE = "ZENOH_SESSION_CONFIG_URI"  # the variable that rmw_zenoh reads
# The threads that read links accept them, too: by default, a message that comes over an accepted
# link wakes the accepting thread, which wakes a reading one.
_THREADS = "ZENOH_RUNTIME", "(acc: (handover: rx))"
_COMMON: dict[str, Any] = {
    "mode": "peer",
    "scouting/multicast/enabled": False,
    # Go on without a router or host, and connect once there is one.
    "connect/timeout_ms": -1,
    "connect/exit_on_failure": False,
    # Latched publishers that are best effort number their messages by time.
    "timestamping/enabled": True,
}
# As rmw_zenoh configures its own. Peers of this host connect directly; those of other hosts go
# through the router.
_SETTINGS: dict[str, Any] = {**_COMMON, "listen/endpoints": ["tcp/localhost:0"]}
_MAX_RETRY_MS = 500  # messages flow again within two seconds after a link was down
_LINK: dict[str, Any] = {
    **_COMMON,
    "scouting/gossip/enabled": False,  # each host knows the addresses of the others
    "transport/shared_memory/enabled": False,
    "connect/retry": {
        "period_init_ms": _MAX_RETRY_MS,
        "period_max_ms": _MAX_RETRY_MS,
        "period_increase_factor": 1,
    },
}


def open_session(connect: Sequence[str]) -> zenoh.Session:
    """Open a session that connects to routers or peers, as soon as they are there."""
    path = os.environ.get(CONFIG_FILE)
    settings = {} if path else dict(_SETTINGS)
    if connect or not path:
        settings["connect/endpoints"] = [*(connect or DEFAULT_CONNECT)]
    return _open(path, settings)


def open_link(listen: Sequence[str], connect: Sequence[str]) -> zenoh.Session:
    """Open a session between hosts; a configuration file adds what TLS needs."""
    ends = {"listen/endpoints": [*listen], "connect/endpoints": [*connect]}
    return _open(os.environ.get(CONFIG_FILE), {**_LINK, **ends})


def _open(path: str | None, settings: Mapping[str, Any]) -> zenoh.Session:
    os.environ.setdefault(*_THREADS)
    config = zenoh.Config.from_file(path) if path else zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)
