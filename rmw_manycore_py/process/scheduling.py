# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scheduling policy and priority of a process, set before its first instruction."""

from __future__ import annotations

import os
import resource
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

POLICIES = {"other": os.SCHED_OTHER, "fifo": os.SCHED_FIFO, "rr": os.SCHED_RR}
REAL_TIME = ("fifo", "rr")
# sched(7); other policies have priority 0.
MIN_PRIORITY, MAX_PRIORITY = 1, 99


@dataclass(frozen=True)
class Scheduling:
    """A policy of sched(7), and its priority: 1 to 99 for fifo and rr, else 0."""

    policy: str
    priority: int = 0

    def __str__(self) -> str:
        return f"{self.policy} {self.priority}" if self.policy in REAL_TIME else self.policy


def own_scheduling() -> Scheduling:
    """Return what a process that this thread starts inherits."""
    number = os.sched_getscheduler(0)  # with SCHED_RESET_ON_FORK it is none of those known
    policy = {value: name for name, value in POLICIES.items()}.get(number, "other")
    return Scheduling(policy, os.sched_getparam(0).sched_priority if policy in REAL_TIME else 0)


def priority_above(schedulings: Iterable[Scheduling]) -> int:
    """Return the real-time priority above all of these if there is one; 0 if none has any."""
    priorities = [one.priority for one in schedulings if one.policy in REAL_TIME]
    return min(max(priorities) + 1, MAX_PRIORITY) if priorities else 0


@contextmanager
def scheduled_as(scheduling: Scheduling | None) -> Iterator[None]:
    """Set the calling thread's scheduling while it starts a process, which inherits it.

    :raises OSError: if this user may not set it.
    """
    if scheduling is None:
        yield
        return
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    _set(scheduling)
    try:
        yield
    finally:
        os.sched_setscheduler(0, *before)


def refusal(scheduling: Scheduling) -> str | None:
    """Return why this process may not use this scheduling, and what to do; None if it may."""
    try:
        with scheduled_as(scheduling):
            return None
    except OSError as error:
        return error.strerror


def real_time_limit() -> int:
    """Return the maximum real-time priority this process may set by its limits."""
    soft, _ = resource.getrlimit(resource.RLIMIT_RTPRIO)
    return MAX_PRIORITY if soft == resource.RLIM_INFINITY else min(soft, MAX_PRIORITY)


def _set(scheduling: Scheduling) -> None:
    try:
        parameters = os.sched_param(scheduling.priority)
        os.sched_setscheduler(0, POLICIES[scheduling.policy], parameters)
    except PermissionError as error:
        raise OSError(error.errno, _advice(scheduling)) from error


def _advice(scheduling: Scheduling) -> str:
    return (
        f"scheduling {scheduling} is not allowed (limit rtprio: {real_time_limit()}): add "
        f"'{_user()} - rtprio {scheduling.priority}' to /etc/security/limits.conf and log in "
        "again; a container needs --cap-add=sys_nice or "
        f"--ulimit rtprio={scheduling.priority}"
    )


def _user() -> str:
    return os.environ.get("USER") or f"#{os.getuid()}"
