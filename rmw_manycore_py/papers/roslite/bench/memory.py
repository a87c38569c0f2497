# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Table I: memory of the cluster of pure_pursuit, while the pipeline runs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.papers.roslite.bench.drives import drive
from rmw_manycore_py.papers.roslite.bench.elf import Sizes, loaded_files, sizes_of
from rmw_manycore_py.papers.roslite.variants import AFTER, installed

NODE = "pure_pursuit"
CODE = f"memory of {NODE}, code"
SMEM = f"memory of {NODE}, SMEM"
RECEIVE, LIBRARY, REST = "receive thread", "library", "node: Python, rclpy, messages"
USED, LEFT = "used", "left for topic data"
SCANS = 20
KIB = 1024
# What ROS-lite leaves of the 2 MB of a cluster.
LEFT_KIB = 1_000_000 / KIB
GOALS = (Goal(SMEM, LEFT, "better", LEFT_KIB),)
_LIBRARY_FILE = "librmw_manycore.so"


def measure(run: Run) -> list[Result]:
    """Run the pipeline and read the state of the cluster once."""
    if not run.wants(f"{CODE}: {LIBRARY}") and not run.wants(f"{SMEM}: {LEFT}"):
        return []
    run.note(CODE)
    try:
        _, results = drive(installed(AFTER), SCANS, meanwhile=_looked)
    except ManycoreError as error:
        run.failures.append(f"{CODE}: {error}")
        return []
    return results


def _looked(platform: str) -> list[Result]:
    with _transport.Platform(platform) as view:
        (slot,) = {e.process for e in view.endpoints() if e.node_name == NODE}
        (pid,) = (process.pid for process in view.processes() if process.slot == slot)
        number = installed(AFTER)["nodes"][NODE]["cluster"]
        (cluster,) = (one for one in view.clusters() if one.id == number)
    files = loaded_files(pid)
    library = [file for file in files if file.name == _LIBRARY_FILE]
    groups = {
        RECEIVE: loaded_files(cluster.receive_thread_pid),
        LIBRARY: library,
        REST: [file for file in files if file not in library],
    }
    used = cluster.used_bytes
    return [
        *(row for name, group in groups.items() for row in _rows(name, group)),
        Result(SMEM, USED, "KiB", (used / KIB,)),
        Result(SMEM, LEFT, "KiB", ((cluster.smem_bytes - used) / KIB,), higher_is_better=True),
    ]


def _rows(name: str, files: Iterable[Path]) -> list[Result]:
    total = sum((sizes for file in files if (sizes := sizes_of(file))), Sizes())
    parts = {"text": total.text, "bss": total.bss, "data": total.data}
    return [Result(CODE, f"{name}: {part}", "KiB", (size / KIB,)) for part, size in parts.items()]
