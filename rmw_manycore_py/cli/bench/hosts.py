# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench hosts`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import linked_hosts
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command("hosts", epilog=examples("manycore bench hosts -o build/hosts"))
@bench_options
def command(**options: Any) -> None:
    """Measure two hosts of one platform.

    Beside plain zenoh and Fast DDS, over a cable of 1 Gbit/s between network namespaces. Needs
    root.
    """
    answer([linked_hosts.QUESTION], **options)
