# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A prediction as JSON data."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rmw_manycore_py.prediction.prediction import CoreUse, Prediction
from rmw_manycore_py.prediction.target import PARAMETERS


def as_data(one: Prediction, deadline_ms: float | None = None) -> dict[str, Any]:
    """Return a prediction with the parameters that it used, and where they come from."""
    target = one.target
    return {
        "platform": target.name,
        "parameters": {
            name: {"value": getattr(target, name), "source": target.sources[name]}
            for name in PARAMETERS
            if name in target.sources
        },
        "duration_s": one.duration_s,
        "executions": one.executions,
        "chains": [
            {**chain.row(), **({"late": chain.late(deadline_ms)} if deadline_ms else {})}
            for chain in one.chains
        ],
        "cores": [_core(core) for core in one.cores],
        "cpus": [asdict(cpu) for cpu in one.cpus],
        "receive_threads": [asdict(thread) for thread in one.receive_threads],
        "smem_bytes": dict(one.smem_bytes),
        "communications": [asdict(each) for each in one.communications],
        "links": [asdict(link) for link in one.links],
        "queues": [asdict(queue) for queue in one.queues],
        "overwritten": dict(one.overwritten),
        "timers": [asdict(timer) for timer in one.timers],
    }


def _core(core: CoreUse) -> dict[str, Any]:
    place = core.core
    return {
        "cluster": place.cluster,
        "core": place.core,
        "nodes": list(core.nodes),
        "cpu_share": core.cpu_share,
    }
