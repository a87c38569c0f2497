# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench machine`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench.placements import questions
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.platform.machine.clusters import clusters_of
from rmw_manycore_py.platform.machine.sysfs import read_cpus
from rmw_manycore_py.platform.topology import usable_cpus


@click.command(
    "machine",
    epilog=examples("manycore bench machine", "manycore bench machine -o build/machine --plot"),
)
@bench_options
def command(**options: Any) -> None:
    """Measure what this machine's clusters are worth.

    Cache lines between all cores, as a matrix with --plot; wake-ups, copies and messages of 64 B
    and 1 MiB between CPUs of one core, cluster, NUMA node and of two nodes, as far as the machine
    has them.
    """
    usable = set(usable_cpus())
    cpus = [cpu for cpu in read_cpus() if cpu.number in usable]
    answer(questions(cpus, clusters_of(cpus)), **options)
