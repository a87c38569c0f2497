# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The options that say how a recording is to be read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])


def recording_options(command: F) -> F:
    """Add the options of `open_recording`."""
    options = [
        click.option(
            "--poses",
            "poses_path",
            type=click.Path(dir_okay=False, exists=True, path_type=Path),
            help="Reference poses of a bag or a folder of scans: KITTI or TUM format.",
        ),
        click.option("--topic", default="", help="The scans in a bag that has several clouds."),
        click.option("--pose-topic", default="", help="The reference poses in a bag."),
    ]
    for option in reversed(options):
        command = option(command)
    return command
