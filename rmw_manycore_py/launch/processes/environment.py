# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Environments that select the middleware of a program."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping

from rmw_manycore_hook import plain_environment, restart, substituted_environment

IMPLEMENTATION = "rmw_manycore"
OUTSIDE_IMPLEMENTATION = "rmw_fastrtps_cpp"


def program_environment(
    variables: Mapping[str, str], base: Mapping[str, str] = os.environ
) -> dict[str, str]:
    """Return `base` plus `variables`, for a program to load rmw_manycore without re-executing."""
    environment = {**base, "RMW_IMPLEMENTATION": IMPLEMENTATION, **variables}
    return substituted_environment(environment, sys.prefix)


def leave_middleware(implementation: str) -> None:
    """Re-execute this program with another middleware."""
    environment = {**os.environ, "RMW_IMPLEMENTATION": implementation}
    restart(plain_environment(environment, sys.prefix))


def outside_environment(base: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return `base` for a program to load Fast DDS, even in a shell set up for rmw_manycore."""
    environment = {**base, "RMW_IMPLEMENTATION": OUTSIDE_IMPLEMENTATION, "PYTHONUNBUFFERED": "1"}
    return plain_environment(environment, sys.prefix)


def enter_middleware() -> None:
    """Re-execute this program with rmw_manycore, unless it is already loaded."""
    if os.environ.get("RMW_IMPLEMENTATION") != IMPLEMENTATION:
        restart(program_environment({}))
