# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options for reading a recording."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])


def recording_options(command: F) -> F:
    """Add the options that `open_recording` takes."""
    options = [
        click.option(
            "--poses",
            "poses_path",
            type=click.Path(dir_okay=False, exists=True, path_type=Path),
            help="Reference poses of a bag or a directory of scans, in KITTI or TUM format.",
        ),
        click.option(
            "--topic", default="", help="Topic of the scans, if the bag has several point clouds."
        ),
        click.option("--pose-topic", default="", help="Topic of the reference poses in a bag."),
    ]
    for option in reversed(options):
        command = option(command)
    return command
