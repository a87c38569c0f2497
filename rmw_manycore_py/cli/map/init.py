# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore map init`: a mapfile template from an application (ROS-lite, Fig. 5 a)."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.mapfile.profiled import plan_of
from rmw_manycore_py.mapfile.template import init
from rmw_manycore_py.platform.topology import PROFILES
from rmw_manycore_py.platform.topology import profile as platform_shape
from rmw_manycore_py.profile.files import load


@click.command(
    "init",
    epilog=examples(
        "manycore map init talker.py listener.py",
        "manycore map init src/ launch/demo.launch.xml --profile coolidge -o map.yaml",
        "manycore map init launch/robot.launch.py namespace:=left -o map.yaml",
        "manycore map init --plan robot.launch.py --profile coolidge -o plan.yaml",
        "manycore map init app.profile.json --profile coolidge -o plan.yaml",
    ),
)
@click.argument("sources", nargs=-1, required=True)
@click.option(
    "--profile",
    type=click.Choice(PROFILES),
    default="host",
    show_default=True,
    help="Shape of the platform: emulated clusters, those of this machine, or a chip.",
)
@click.option(
    "--plan",
    is_flag=True,
    help="Include nodes that are not installed here, each with a comment on missing packages.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File to write; must not exist.  [default: standard output]",
)
def command(sources: tuple[str, ...], profile: str, plan: bool, output: Path | None) -> None:
    """Write a mapfile template for the nodes in SOURCES.

    Its clusters are a proposal: nodes that exchange messages share one. SOURCES are Python
    files, directories of them, and at most one launch file with values for its arguments as
    NAME:=VALUE. To plan a chip for a launch file, its packages need not be installed: --plan
    gives each of its nodes a core, and 'map check' and 'map show' take them. Of an application
    that only a profile describes, the profile is the single source.
    """
    if len(sources) == 1 and sources[0].endswith(".json"):
        text = plan_of(load(Path(sources[0])), platform_shape(profile))
    else:
        arguments = dict(_argument(source) for source in sources if ":=" in source)
        files = [Path(source) for source in sources if ":=" not in source]
        text = init(files, output.parent if output else None, profile, arguments, plan=plan)
    if output is None:
        echo(text, nl=False)
        return
    try:
        with output.open("x", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise ManycoreError(f"{output}: {error.strerror}", EXIT_BAD_INPUT) from error


def _argument(text: str) -> tuple[str, str]:
    """Return name and value of a launch argument; `ros2 launch` refuses the same ones."""
    name, _, value = text.partition(":=")
    if not (name and value):
        raise ManycoreError(f"'{text}': expected NAME:=VALUE", EXIT_BAD_INPUT)
    return name, value
