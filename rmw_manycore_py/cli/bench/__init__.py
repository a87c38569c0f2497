# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench`: benchmarks of rmw_manycore on this machine."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.group import LazyGroup

_NAMES = (
    *("advise", "all", "autoware", "bridge", "copies", "fields", "hosts", "idle", "machine"),
    *("matrix", "memory", "ndt", "noc", "pairs", "predict", "rclpy", "record", "reference"),
    *("rmw", "ros-lite", "scale", "startup", "trace", "view", "virtual", "whill"),
)
VERBS = {verb: f"rmw_manycore_py.cli.bench.{verb.replace('-', '_')}:command" for verb in _NAMES}


@click.group("bench", cls=LazyGroup, commands_at=VERBS)
def command() -> None:
    """Benchmark rmw_manycore against its peers.

    Fast DDS, and the limits of the machine.
    """
