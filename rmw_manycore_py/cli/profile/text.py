# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One line about a profile."""

from __future__ import annotations

from rmw_manycore_py.cli.common.printing import counted
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.profile.summary import summary_of


def summary_text(profile: Profile) -> str:
    """Return how much a profile holds."""
    summary = summary_of(profile)
    parts = [counted(summary["nodes"], "node"), counted(summary["callbacks"], "callback")]
    if summary["executions"] is not None:
        parts.append(counted(summary["executions"], "execution"))
    return ", ".join(parts)
