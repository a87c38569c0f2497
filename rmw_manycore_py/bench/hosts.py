# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Two hosts connected by a cable, emulated by network namespaces (ip-netns(8))."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

Host = list[str]  # command prefix that runs a program there
# Namespaces of one machine share memory, hosts do not.
NETWORK = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4"}
ADDRESSES = ("10.77.0.1", "10.77.0.2")
CABLE = "cable"
_BURST = "256kb"  # of a shaped cable: several times what a timer tick lets pass


def can_have_hosts() -> bool:
    """Return whether this user may create network namespaces."""
    return os.geteuid() == 0 and shutil.which("ip") is not None


@contextmanager
def two_hosts(rate: str | None = None) -> Iterator[tuple[Host, Host]]:
    """Create both hosts, and remove them at the end.

    :param rate: of the cable, as tc(8) has it; unlimited by default.
    """
    names = [f"bench{os.getpid()}{side}" for side in "ab"]
    with ExitStack() as ending:
        for name in names:
            _ip("netns", "add", name)
            ending.callback(_ip, "netns", "del", name)
        end, other_end = (("netns", name) for name in names)
        _ip("link", "add", CABLE, *end, "type", "veth", "peer", "name", CABLE, *other_end)
        for name, address in zip(names, ADDRESSES, strict=True):
            _ip("-n", name, "addr", "add", f"{address}/24", "dev", CABLE)
            for device in ("lo", CABLE):
                _ip("-n", name, "link", "set", device, "up")
            _ip("-n", name, "route", "add", "224.0.0.0/4", "dev", CABLE)
            if rate is not None:
                _shape(name, rate)
        here, there = (["ip", "netns", "exec", name] for name in names)
        yield here, there


def _shape(name: str, rate: str) -> None:
    limit = ("rate", rate, "burst", _BURST, "latency", "50ms")
    command = ["tc", "-n", name, "qdisc", "add", "dev", CABLE, "root", "tbf", *limit]
    subprocess.run(command, check=True, capture_output=True)


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True)
