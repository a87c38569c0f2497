# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore whill`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

VERBS = {verb: f"rmw_manycore_py.cli.whill.{verb}:command" for verb in ("course", "drive", "sweep")}


@click.group("whill", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Drive the wheelchair of ROS-lite2.

    A case study with off-loaded localization and control.
    """
