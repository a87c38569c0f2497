# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS 2 middleware for clustered many-core processors, on an ordinary Linux host.

```python
import rmw_manycore_py as manycore

placement = manycore.resolve(manycore.load_mapfile("map.yaml"))  # MapfileError: every fault
with manycore.run("map.yaml") as active:
    print(manycore.status(active.platform).nodes)
```

Two packages stand beside it: `rmw_manycore_py.transport` joins a platform without ROS, and
`rmw_manycore_py.ndt` matches LiDAR scans. The names here are loaded on first use, without rclpy.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as typing has it, whose import would take longer than all of this
if TYPE_CHECKING:
    from typing import Any

    from rmw_manycore_py.errors import FileError, ManycoreError, MapfileError, Problem
    from rmw_manycore_py.launch.active_run import ActiveRun, NodeStatus, run
    from rmw_manycore_py.mapfile import Mapfile, PlacedNode, Placement, load_mapfile, resolve
    from rmw_manycore_py.platform.status import (
        ClusterStatus,
        EndpointStatus,
        PlatformStatus,
        ProcessStatus,
        platforms,
        status,
    )

__version__ = "0.3.0"

__all__ = [
    "ActiveRun",
    "ClusterStatus",
    "EndpointStatus",
    "FileError",
    "ManycoreError",
    "Mapfile",
    "MapfileError",
    "NodeStatus",
    "PlacedNode",
    "Placement",
    "PlatformStatus",
    "Problem",
    "ProcessStatus",
    "load_mapfile",
    "platforms",
    "resolve",
    "run",
    "status",
]

_MODULES = {
    "errors": ("FileError", "ManycoreError", "MapfileError", "Problem"),
    "launch.active_run": ("ActiveRun", "NodeStatus", "run"),
    "mapfile": ("Mapfile", "PlacedNode", "Placement", "load_mapfile", "resolve"),
    "platform.status": (
        *("ClusterStatus", "EndpointStatus", "PlatformStatus", "ProcessStatus"),
        *("platforms", "status"),
    ),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Load a name on its first use."""
    if name in _HOMES:
        from importlib import import_module

        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
