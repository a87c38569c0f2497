# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles from measurements of other tools."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, FileError, ManycoreError, Problem
from rmw_manycore_py.profile.caret import import_report
from rmw_manycore_py.profile.ctf_metadata import check_metadata
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.profile.ros2_tracing import Window, import_trace


def import_source(directory: Path, window: Window) -> Profile:
    """Return the profile of an LTTng trace or of a report of CARET.

    :raises ManycoreError: if a program is missing; FileError if the source cannot be used.
    """
    if any(directory.rglob("metadata")):
        check_metadata(directory)
        profile = import_trace(directory, window)
        if not profile.callbacks:
            expected = "callbacks (ros2:callback_start) within --begin and --end"
            raise FileError(Problem(directory, 0, "", expected, "none"))
        return profile
    if not any(directory.rglob("architecture*.yaml")):
        expected = "an LTTng trace (a file metadata), or a CARET report (architecture*.yaml)"
        raise FileError(Problem(directory, 0, "", expected, "neither"))
    if window != Window():
        text = f"{directory}: a report has no times, so --begin and --end do not apply"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    if not any(directory.rglob("stats_node.yaml")):
        expected = "statistics of callbacks (stats_node.yaml)"
        raise FileError(Problem(directory, 0, "", expected, "none"))
    return import_report(directory)
