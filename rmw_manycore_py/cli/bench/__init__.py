# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench`: the figures of rmw_manycore, measured here and now."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

_NAMES = (
    *("all", "bridge", "idle", "memory", "ndt", "pairs", "rclpy", "record", "reference", "rmw"),
    *("scale", "startup", "trace", "view", "whill"),
)
VERBS = {verb: f"rmw_manycore_py.cli.bench.{verb}:command" for verb in _NAMES}


@click.group("bench", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Measure rmw_manycore beside Fast DDS and beside the machine itself."""
