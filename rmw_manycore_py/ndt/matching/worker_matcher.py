# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The matcher on worker processes, each pinned to its core."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.matcher import CANNOT_WORK, Matcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.voxel_map import VoxelMap

WORKER = "manycore_ndt_worker"


class WorkerMatcher(Matcher):
    """Matches on workers, one process per host CPU; the caller blocks meanwhile.

    Results are bit-identical to :class:`SerialMatcher` for any number of workers. A killed worker
    is replaced and the alignment repeated. Idle workers sleep. They end with :meth:`close`, and
    with this process however it ends.

    :param host_cpus: one worker each; a CPU may be listed more than once.
    :raises ManycoreError: if a CPU is not in the affinity mask, or the worker program is not
        installed.
    """

    def __init__(self, options: MatcherOptions | None, host_cpus: Sequence[int]) -> None:
        options = options or MatcherOptions()
        with translate_native_errors(exit_status=EXIT_BAD_INPUT):
            group = _ndt.WorkerGroup(
                match_options(options), str(_worker_program()), [int(cpu) for cpu in host_cpus]
            )
        super().__init__(options, group)
        self._group: _ndt.WorkerGroup | None = group

    def set_map(self, voxel_map: VoxelMap) -> None:
        """Switch to this map once all workers have attached to it; on failure the old one stays."""
        with translate_native_errors(CANNOT_WORK):
            self._require_group().prepare(voxel_map.levels)
        super().set_map(voxel_map)

    def shared_bytes(self, points: int = 0, next_map: VoxelMap | None = None) -> int:
        """Return the size of session, scan and map in bytes."""
        maps = sum(voxel_map.size_bytes for voxel_map in (self._map, next_map) if voxel_map)
        return self._require_group().memory_bytes(points) + maps

    def close(self) -> None:
        """Stop the workers."""
        super().close()
        self._group = None
        self._native = _Closed()

    @property
    def worker_pids(self) -> list[int]:
        """Return the process ids of the workers, in the order of their host CPUs."""
        return self._require_group().pids()

    @property
    def replaced_workers(self) -> int:
        """Return the number of workers replaced so far."""
        return self._require_group().replaced()

    def passes(self) -> list[tuple[int, int, int, int]]:
        """Return worker, pass, start and end [ns, CLOCK_MONOTONIC] of the last result's passes."""
        return self._require_group().passes()

    @property
    def busy_ns(self) -> list[float]:
        """Return the working time of each worker for the last result in ns, without waiting."""
        return self._require_group().busy_ns()

    def _require_group(self) -> _ndt.WorkerGroup:
        if self._group is None:
            raise ManycoreError("the matcher is closed", EXIT_BAD_INPUT)
        return self._group


class _Closed:
    """Replaces the native matcher after `close`."""

    def align(self, *_: object) -> NoReturn:
        raise ManycoreError("the matcher is closed", EXIT_BAD_INPUT)

    evaluate = search = align


def _worker_program() -> Path:
    # An installation has site-packages in <prefix>/lib/pythonX.Y; a build tree, and what
    # `pip install --target` fills, is next to lib.
    here = Path(_ndt.__file__).resolve()
    prefixes = [*here.parents[5:6], *here.parents[2:3], Path(sys.prefix)]
    for prefix in prefixes:
        program = prefix / "lib" / "rmw_manycore" / WORKER
        if program.exists():
            return program
    raise ManycoreError(f"{WORKER} was not found near {here}: reinstall rmw-manycore")
