# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Faults that a drive is disturbed with: `NODE@T`, `stop:NODE@T`, `lidar@T`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.whill.laptop.wheelchair import SENSORS

STOP_S = 2.0  # for which a stopped process stays stopped
_FAULT = re.compile(r"(?P<stop>stop:)?(?P<target>[^@]+)@(?P<after>\d+(\.\d+)?)")


class Kind(Enum):
    """What is done to the target."""

    KILL = "kill -9"
    STOP = "SIGSTOP"
    SILENCE = "no more messages"


@dataclass(frozen=True)
class Fault:
    """A fault some seconds after the vehicle has begun to drive."""

    kind: Kind
    target: str  # a process of the run, or a sensor
    after_s: float

    def __str__(self) -> str:
        return f"{self.kind.value}: {self.target}"


def fault_of(text: str) -> Fault:
    """Return the fault that a text means.

    :raises ManycoreError: when it means none.
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
