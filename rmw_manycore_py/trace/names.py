# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Display names of processes."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.trace.events import EndpointId, Kind, Process, Thread, Trace, endpoint_ids

_MAX_CORES = 1000  # more than a cluster has


def core_name(process: Process) -> str:
    """Return the core of a process, or its role."""
    if process.is_receive_thread:
        return "receive thread"
    return "no core" if process.core is None else f"core {process.core}"


def place_name(process: Process) -> str:
    """Return cluster and core of a process."""
    return f"cluster {process.cluster} > {core_name(process)}"


def place_order(process: Process) -> int:
    """Return a sort key: by cluster, receive thread first, then by core."""
    core = -1 if process.core is None else process.core
    return process.cluster * _MAX_CORES + (0 if process.is_receive_thread else core + 2)


def process_name(trace: Trace, process: Process) -> str:
    """Return the nodes of a process, else the label used by the tools."""
    if process.is_receive_thread:
        return f"receive thread {process.cluster}"
    return ", ".join(nodes_of(trace, process)) or process.label


def nodes_of(trace: Trace, process: Process) -> list[str]:
    """Return the nodes that publish or take in a process, by name."""
    acting = [endpoint for thread in process.threads for endpoint in _acting(thread)]
    return sorted({trace.node_of(endpoint) for endpoint in acting})


def _acting(thread: Thread) -> set[EndpointId]:
    """Return the endpoints that publish or take in a thread."""
    events = thread.events
    own = events[np.isin(events["kind"], (Kind.PUBLISH_BEGIN, Kind.CLAIM))]
    return set(np.unique(endpoint_ids(own)).tolist())
