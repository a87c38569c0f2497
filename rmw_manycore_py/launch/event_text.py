# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events as text, for terminals and logs."""

from __future__ import annotations

from rmw_manycore_py.launch.events import (
    Ended,
    Event,
    Finished,
    Held,
    Notice,
    Restarting,
    SignalEscalated,
    Started,
    Stopping,
)
from rmw_manycore_py.platform.topology import host_cpu_text

SUPERVISOR = "manycore"  # prefix of the run's own output


def text_of(event: Event) -> str | None:
    """Return the text of an event; None if it is not printed."""
    if isinstance(event, Notice):
        return event.text
    if isinstance(event, Held):
        return f"time stands at {event.at_s:.9g} s: {event.why}"
    if isinstance(event, Started):
        return (
            f"{event.node} started: cluster {event.cluster} core {event.core} -> "
            f"host CPU {host_cpu_text(event.host_cpu)}, pid {event.pid}"
        )
    if isinstance(event, Stopping):
        return f"stopping: {event.reason}"
    if isinstance(event, SignalEscalated):
        return f"{event.node} does not stop: sending {event.signal}"
    if isinstance(event, Restarting):
        return f"{event.node} is started again: {event.reason}"
    if isinstance(event, Ended):
        return f"{event.node} {event.state}: {event.reason}"
    if isinstance(event, Finished):
        return f"the run has ended with exit status {event.exit_status}"
    return None
