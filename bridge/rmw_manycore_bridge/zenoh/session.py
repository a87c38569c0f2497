# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Zenoh sessions of bridge processes."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import zenoh

from rmw_manycore_bridge.outside.interface import OutsideError

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
    # One queue: messages arrive after the token of their publisher, and before it is withdrawn.
    "transport/unicast/qos/enabled": False,
}
_TLS_FILES = tuple(
    f"transport/link/tls/{name}"
    for name in (
        "root_ca_certificate",
        *("listen_certificate", "listen_private_key"),
        *("connect_certificate", "connect_private_key"),
    )
)


def _retried(side: str) -> dict[str, Any]:
    """Return the period in which a session tries again to listen or to connect."""
    periods = {"period_init_ms": _MAX_RETRY_MS, "period_max_ms": _MAX_RETRY_MS}
    return {f"{side}/retry": {**periods, "period_increase_factor": 1}}


def open_session(connect: Sequence[str]) -> zenoh.Session:
    """Open a session that connects to routers or peers, as soon as they are there."""
    path = os.environ.get(CONFIG_FILE)
    settings = {} if path else dict(_SETTINGS)
    if connect or not path:
        settings["connect/endpoints"] = [*(connect or DEFAULT_CONNECT)]
    return _open(path, settings)


def open_listening(address: str, waits: bool) -> zenoh.Session:
    """Open a session that other hosts connect to.

    :param waits: whether to listen once the address is there.
    :raises zenoh.ZError: if it cannot listen, and does not wait.
    """
    waiting = {**_retried("listen"), "listen/exit_on_failure": False, "listen/timeout_ms": -1}
    ends = {"listen/endpoints": [address], "connect/endpoints": []}
    return _open(os.environ.get(CONFIG_FILE), {**_LINK, **ends, **(waiting if waits else {})})


def open_connecting(addresses: Sequence[str]) -> zenoh.Session:
    """Open a session that connects to another host; a configuration file adds what TLS needs."""
    ends = {"listen/endpoints": [], "connect/endpoints": [*addresses]}
    return _open(os.environ.get(CONFIG_FILE), {**_LINK, **_retried("connect"), **ends})


def _open(path: str | None, settings: Mapping[str, Any]) -> zenoh.Session:
    os.environ.setdefault(*_THREADS)
    config = _from_file(Path(path)) if path else zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def _from_file(path: Path) -> zenoh.Config:
    """Return a configuration; names of files in it are relative to it.

    :raises OutsideError: if it, or a file that it names, is missing or invalid.
    """
    try:
        config: zenoh.Config = zenoh.Config.from_file(path)
    except zenoh.ZError as error:
        raise OutsideError(f"{CONFIG_FILE}={path}: {error}") from error
    for key in _TLS_FILES:
        name = json.loads(config.get_json(key))
        if name is None:
            continue
        file = path.resolve().parent / name
        if not file.is_file():
            raise OutsideError(f"{path}: {key}: there is no file {file}")
        config.insert_json5(key, json.dumps(str(file)))
    return config
