# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Faults injected into a drive: `NODE@T`, `stop:NODE@T`, `lidar@T`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.papers.roslite2.laptop.wheelchair import SENSORS

STOP_S = 2.0  # duration of a SIGSTOP
_FAULT = re.compile(r"(?P<stop>stop:)?(?P<target>[^@]+)@(?P<after>\d+(\.\d+)?)")


class Kind(Enum):
    """Action on the target."""

    KILL = "kill -9"
    STOP = "SIGSTOP"
    SILENCE = "no more messages"


@dataclass(frozen=True)
class Fault:
    """A fault some seconds after the start of the drive."""

    kind: Kind
    target: str  # process of the run, or sensor
    after_s: float

    def __str__(self) -> str:
        return f"{self.kind.value}: {self.target}"


def fault_of(text: str) -> Fault:
    """Parse a fault.

    :raises ManycoreError: for an invalid text.
    """
    found = _FAULT.fullmatch(text)
    if found is None:
        raise ManycoreError(
            f"--fault: expected NODE@SECONDS, stop:NODE@SECONDS or {'|'.join(SENSORS)}@SECONDS, "
            f"found '{text}'",
            EXIT_BAD_INPUT,
        )
    target = found["target"]
    kind = Kind.STOP if found["stop"] else Kind.SILENCE if target in SENSORS else Kind.KILL
    return Fault(kind, target, float(found["after"]))
