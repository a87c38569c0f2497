# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS domain of this process, and the corresponding platform."""

from __future__ import annotations

import os
import re

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

# The last domain whose ports are below Linux's ephemeral range.
MAX_DOMAIN = 232
# Same as PlatformPaths::is_name in rmw_manycore/transport/registry/cluster.cpp.
PLATFORM_NAME = r"^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$"


def ros_domain() -> int:
    """Return ROS_DOMAIN_ID, 0 if unset.

    :raises ManycoreError: if it is not a valid domain.
    """
    text = os.environ.get("ROS_DOMAIN_ID") or "0"
    if not text.isdecimal() or int(text) > MAX_DOMAIN:
        raise ManycoreError(
            f"ROS_DOMAIN_ID: expected a number from 0 to {MAX_DOMAIN}, found '{text}'",
            EXIT_BAD_INPUT,
        )
    return int(text)


def default_platform(domain: int | str | None = None) -> str:
    """Return the platform of a process without a mapfile or option that names one.

    :param domain: ROS domain, if known by rcl; default: ROS_DOMAIN_ID.
    :raises ManycoreError: if MANYCORE_PLATFORM is not a valid platform name.
    """
    if named := os.environ.get("MANYCORE_PLATFORM"):
        return checked_platform(named, "MANYCORE_PLATFORM")
    if domain is None:
        domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    return f"domain-{domain}"


def checked_platform(name: str, place: str) -> str:
    """Return a platform name after validation.

    :param place: option or variable that the name comes from.
    :raises ManycoreError: if it is invalid; it is used as a directory name.
    """
    if re.fullmatch(PLATFORM_NAME, name) is None:
        raise ManycoreError(
            f"{place}: expected a platform name of up to 64 letters, digits, '_', '.' and '-', "
            f"not starting with '.' or '-', found {name!a}",
            EXIT_BAD_INPUT,
        )
    return name
