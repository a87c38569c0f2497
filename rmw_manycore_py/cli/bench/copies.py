# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench copies`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import (
    camera_hop,
    copies,
    fields,
    image_round_trip,
    lent,
    many_topics,
    readers,
)
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command("copies", epilog=examples("manycore bench copies --quick"))
@bench_options
def command(**options: Any) -> None:
    """Measure large messages in rclpy.

    With and without copies: takes, round trips, fields, several readers, a camera; lent ones; many
    topics.
    """
    modules = (copies, image_round_trip, fields, readers, camera_hop, lent, many_topics)
    answer([module.QUESTION for module in modules], **options)
