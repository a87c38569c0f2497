# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS domain of this process, and the corresponding platform."""

from __future__ import annotations

import ctypes
import os
import re
from collections.abc import Mapping

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

# The last domain whose ports are below Linux's ephemeral range.
MAX_DOMAIN = 232
# Same as PlatformPaths::is_name in rmw_manycore/transport/registry/cluster.cpp.
PLATFORM_NAME = r"^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$"
_strtoul = ctypes.CDLL(None).strtoul
_strtoul.restype = ctypes.c_ulong


def ros_domain() -> int:
    """Return ROS_DOMAIN_ID, 0 if unset.

    :raises ManycoreError: if it is not a valid domain.
    """
    domain, rest = _number(_text())
    if rest or domain > MAX_DOMAIN:
        raise _refused()
    return domain


def default_platform(domain: int | None = None) -> str:
    """Return the platform of a process without a mapfile or option that names one.

    The same as Placement::from_environment in rmw_manycore/transport/placement.cpp.

    :param domain: ROS domain of a context; default: ROS_DOMAIN_ID, the one that MANYCORE_PLATFORM
        stands for.
    :raises ManycoreError: if MANYCORE_PLATFORM is not a valid platform name, or ROS_DOMAIN_ID not a
        number, with which rcl starts no node either.
    """
    own = _own_domain()
    named = os.environ.get("MANYCORE_PLATFORM")
    if named and domain in (None, own):
        return checked_platform(named, "MANYCORE_PLATFORM")
    return f"domain-{own if domain is None else domain}"


def is_elsewhere(node: Mapping[str, str], base: Mapping[str, str] = os.environ) -> bool:
    """Return whether a node's variables move it to another ROS domain than that of its run.

    :param node: variables that the node has beyond `base`, or all of them.
    """
    return _domain_of({**base, **node}) != _domain_of(base)


def _own_domain() -> int:
    domain, rest = _number(_text())
    if rest and domain == 0:  # rcl takes 7x for 7
        raise _refused()
    return domain


def _text() -> str:
    return os.environ.get("ROS_DOMAIN_ID") or "0"


def _refused() -> ManycoreError:
    return ManycoreError(
        f"ROS_DOMAIN_ID: expected a number from 0 to {MAX_DOMAIN}, found '{_text()}'",
        EXIT_BAD_INPUT,
    )


def _domain_of(environment: Mapping[str, str]) -> int:
    return _number(environment.get("ROS_DOMAIN_ID", ""))[0]


def _number(text: str) -> tuple[int, bytes]:
    """Return the number at the start of a text as rcl and the transport read it, and the rest.

    They use strtoul of any base: 010 is 8, and 0x5 is 5.
    """
    rest = ctypes.c_char_p()
    encoded = ctypes.create_string_buffer(os.fsencode(text))
    number: int = _strtoul(encoded, ctypes.byref(rest), 0)
    return number, rest.value or b""


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
