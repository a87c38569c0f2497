# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Matcher of a node: on its own thread, or on the workers assigned by its mapfile."""

from __future__ import annotations

import os

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.matching.serial_matcher import SerialMatcher
from rmw_manycore_py.ndt.matching.worker_matcher import WorkerMatcher
from rmw_manycore_py.platform.topology import WORKER_CPUS


def make_matcher(options: MatcherOptions, named_cpus: tuple[int, ...]) -> Matcher:
    """Return a matcher with a worker per host CPU; default: those assigned by the mapfile.

    Several workers on one CPU would wait for each other, so cores that share a host CPU share a
    worker; if only one remains, the node's own thread is used.
    """
    cpus = sorted(set(named_cpus or _mapfile_cpus()))
    return WorkerMatcher(options, cpus) if len(cpus) > 1 else SerialMatcher(options)


def _mapfile_cpus() -> tuple[int, ...]:
    text = os.environ.get(WORKER_CPUS, "")
    try:
        return tuple(int(word) for word in text.split(",") if word)
    except ValueError as error:
        raise ManycoreError(
            f"{WORKER_CPUS}: expected numbers separated by commas, found '{text}'", EXIT_BAD_INPUT
        ) from error
