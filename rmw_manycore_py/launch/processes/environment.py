# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The environment in which a program finds rmw_manycore."""

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
    """Return `base` with `variables` in it, as a program needs it to load rmw_manycore at once."""
    environment = {**base, "RMW_IMPLEMENTATION": IMPLEMENTATION, **variables}
    return substituted_environment(environment, sys.prefix)


def leave_middleware(implementation: str) -> None:
    """Restart this program with another middleware."""
    environment = {**os.environ, "RMW_IMPLEMENTATION": implementation}
    restart(plain_environment(environment, sys.prefix))


def outside_environment(base: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return `base` as a program needs it to load Fast DDS, even in a shell of rmw_manycore."""
    environment = {**base, "RMW_IMPLEMENTATION": OUTSIDE_IMPLEMENTATION, "PYTHONUNBUFFERED": "1"}
    return plain_environment(environment, sys.prefix)


def enter_middleware() -> None:
    """Restart this program with rmw_manycore loaded, unless the start-up hook has done so."""
    if os.environ.get("RMW_IMPLEMENTATION") != IMPLEMENTATION:
        restart(program_environment({}))
