# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore step`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.holding import ask_for_time
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.launch.requests import MAX_STEP_S
from rmw_manycore_py.ros.names import expand


@click.command(
    "step",
    epilog=examples("manycore step", "manycore step --for 0.1", "manycore step --topic /scan"),
)
@click.option("--for", "for_s", type=Seconds(), help="Let this much time pass.")
@click.option("--topic", default="", help="Go on until something is published on this topic.")
@platform_option
def command(for_s: float | None, topic: str, platform: str) -> None:
    """Advance virtual time, then pause.

    Without options, to the next event. Then time stands, as after `manycore pause`: look at topics,
    parameters or a debugger as long as you like. With both options, whichever comes first.
    """
    if for_s is not None and for_s > MAX_STEP_S:
        raise click.UsageError(f"--for: expected at most {MAX_STEP_S:g} s.")
    topic = topic and expand(topic, "/")
    single = for_s is None and not topic
    ask_for_time(platform, "resume", waits=True, for_s=for_s, topic=topic, single=single)
