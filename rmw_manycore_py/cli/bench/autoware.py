# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench autoware`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.bench.scale import application
from rmw_manycore_py.bench.scale.skeleton import skeleton_of
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options
from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.profile.files import load

_EXAMPLES = examples(
    "manycore bench autoware autoware.profile.json -o build/autoware",
    "manycore bench autoware autoware.profile.json --only manycore --duration 60s",
)


@click.command("autoware", epilog=_EXAMPLES)
@click.argument("profile", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@duration_option(20.0, "Seconds to publish.", endless=False)
@bench_options
def command(profile: Path, duration_s: float, **options: Any) -> None:
    """Run the skeleton of a large application.

    PROFILE comes from `manycore profile`, such as one of a trace of Autoware. Each node becomes a
    native process with the node's publishers, subscriptions and parameter services, without its
    work. Messages come evenly at the profile's rates, with assumed sizes where it has none. Over
    a quarter, half and all nodes, beside Fast DDS: start, rest, descriptors, memory, tools,
    losses and ages.
    """
    answer([application.question(skeleton_of(load(profile)), duration_s)], **options)
