# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Outcome of a fault: when the vehicle stopped, which node reported it, when it drove on."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from rmw_manycore_py.papers.roslite2.laptop.drive_log import Command, DriveLog, Injected
from rmw_manycore_py.papers.roslite2.laptop.plant import COMMAND_TIMEOUT_S

WINDOW_S = 3.0  # later stops have another cause
NAMING_S = 5.0
GONE, RESTARTED = "is gone", "is started again"


@dataclass(frozen=True)
class Outcome:
    """Times in seconds after the fault; None if it did not happen.

    :param stood_s: first zero command, or the wheelchair's own timeout.
    :param drove_on_s: first driving command after that.
    :param named_by: warnings in which a node reported the dead one as gone.
    """

    fault: str
    target: str
    stood_s: float | None
    drove_on_s: float | None
    named_by: tuple[str, ...]
    was_restarted: bool


def outcomes(log: DriveLog) -> list[Outcome]:
    """Return the outcome of each fault of a drive."""
    return [_outcome(log, injected) for injected in log.injected]


def _outcome(log: DriveLog, injected: Injected) -> Outcome:
    name = injected.target.strip("()")
    node = name.replace(" ", "_")  # bridge processes are named _manycore_bridge_inward etc.
    since = [i.text for i in log.incidents if 0.0 <= i.time_s - injected.time_s <= NAMING_S]
    stood_s = stands_after_s(log.commands, injected.time_s)
    return Outcome(
        injected.text,
        injected.target,
        stood_s,
        None if stood_s is None else _drives_after_s(log.commands, injected.time_s, stood_s),
        tuple(text for text in since if GONE in text and node in text.rpartition(": ")[2]),
        any(RESTARTED in text and name in text for text in since),
    )


def stands_after_s(commands: list[Command], fault_s: float) -> float | None:
    """Return the time from a fault to the first zero command or the end of commands."""
    before = [one for one in commands if one.time_s <= fault_s][-1:]
    after = [one for one in commands if fault_s < one.time_s]
    found = [one.time_s - fault_s for one in after if one.speed_m_s == 0.0][:1]
    for last, following in pairwise([*before, *after]):
        if following.time_s - last.time_s > COMMAND_TIMEOUT_S:
            found.append(last.time_s + COMMAND_TIMEOUT_S - fault_s)
            break
    return min((one for one in found if one <= WINDOW_S), default=None)


def _drives_after_s(commands: list[Command], fault_s: float, stood_s: float) -> float | None:
    times = (c.time_s - fault_s for c in commands if c.speed_m_s > 0.0)
    return next((time_s for time_s in times if time_s > stood_s), None)
