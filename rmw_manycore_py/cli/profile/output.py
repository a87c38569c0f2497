# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The profile that a command writes."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.common.printing import counted, echo
from rmw_manycore_py.profile.files import save
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.profile.summary import summary_of

output_option = click.option(
    "-o",
    "--output",
    type=OutputFile(".json"),
    default="app.profile.json",
    show_default=True,
    help="File to write.",
)


def write(profile: Profile, path: Path) -> None:
    """Save a profile and print its counts."""
    save(profile, path)
    summary = summary_of(profile)
    parts = [counted(summary["nodes"], "node"), counted(summary["callbacks"], "callback")]
    if summary["executions"] is not None:
        parts.append(counted(summary["executions"], "execution"))
    echo(f"{path}: {', '.join(parts)}")
