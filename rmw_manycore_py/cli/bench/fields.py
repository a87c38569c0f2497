# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench fields`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import fields
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.options import examples


@click.command("fields", epilog=examples("manycore bench fields -o build/fields"))
@bench_options
def command(**options: Any) -> None:
    """Measure assignments of numpy arrays to fields.

    Beside the generated classes alone.
    """
    answer([fields.QUESTION], **options)
