# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The ROS domain of this process, and the platform that it stands for."""

from __future__ import annotations

import os
import re

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

# The last domain whose ports lie below the ephemeral ones of Linux's largest choice.
MAX_DOMAIN = 232
# As PlatformPaths::is_name in rmw_manycore/transport/registry/cluster.cpp.
PLATFORM_NAME = r"^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$"


def ros_domain() -> int:
    """Return ROS_DOMAIN_ID, 0 where it is not set.

    :raises ManycoreError: when it is not a domain of DDS.
    """
    text = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not text.isdecimal() or int(text) > MAX_DOMAIN:
        raise ManycoreError(
            f"ROS_DOMAIN_ID: expected a number from 0 to {MAX_DOMAIN}, found '{text}'",
            EXIT_BAD_INPUT,
        )
    return int(text)


def default_platform(domain: int | str | None = None) -> str:
    """Return the platform of a process whose mapfile or options name none.

    :param domain: the ROS domain, where rcl knows it; by default ROS_DOMAIN_ID.
    :raises ManycoreError: when MANYCORE_PLATFORM is no platform name.
    """
    if named := os.environ.get("MANYCORE_PLATFORM"):
        return checked_platform(named, "MANYCORE_PLATFORM")
    if domain is None:
        domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    return f"domain-{domain}"


def checked_platform(name: str, place: str) -> str:
    """Return a platform name.

    :param place: the option or variable that the name comes from.
    :raises ManycoreError: when it is none; it would be the name of a directory.
    """
    if re.fullmatch(PLATFORM_NAME, name) is None:
        raise ManycoreError(
            f"{place}: expected a platform name of up to 64 letters, digits, '_', '.' and '-', "
            f"the first none of '.' and '-', found {name!a}",
            EXIT_BAD_INPUT,
        )
    return name
