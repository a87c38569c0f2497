# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The ROS domain of this process, and the platform that it stands for."""

from __future__ import annotations

import os

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

# The last domain whose ports lie below the ephemeral ones of Linux's largest choice.
MAX_DOMAIN = 232


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
    """
    if domain is None:
        domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    return os.environ.get("MANYCORE_PLATFORM") or f"domain-{domain}"
