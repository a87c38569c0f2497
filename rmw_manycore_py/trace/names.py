# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What processes are called."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.trace.events import EndpointId, Kind, Process, Thread, Trace, endpoint_ids

_MAX_CORES = 1000  # more than a cluster has


def core_name(process: Process) -> str:
    """Return what a process runs on."""
    if process.is_receive_thread:
        return "receive thread"
    return "no core" if process.core is None else f"core {process.core}"


def place_name(process: Process) -> str:
    """Return where a process runs, with its cluster."""
    return f"cluster {process.cluster} > {core_name(process)}"


def place_order(process: Process) -> int:
    """Return a number to sort by: clusters, in each its receive thread first, then its cores."""
    core = -1 if process.core is None else process.core
    return process.cluster * _MAX_CORES + (0 if process.is_receive_thread else core + 2)


def process_name(trace: Trace, process: Process) -> str:
    """Return the nodes of a process, else what the tools call it."""
    if process.is_receive_thread:
        return f"receive thread {process.cluster}"
    own = {trace.node_of(endpoint) for thread in process.threads for endpoint in _acting(thread)}
    return ", ".join(sorted(own)) or process.label


def _acting(thread: Thread) -> set[EndpointId]:
    """Return the endpoints that publish and take in a thread."""
    events = thread.events
    own = events[np.isin(events["kind"], (Kind.PUBLISH_BEGIN, Kind.CLAIM))]
    return set(np.unique(endpoint_ids(own)).tolist())
