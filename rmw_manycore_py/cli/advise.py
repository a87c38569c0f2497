# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore advise`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from rmw_manycore_py.advice.advising import Advice, Request, advise
from rmw_manycore_py.advice.explanation import as_data, sentences
from rmw_manycore_py.advice.isolated_executor import thread_configuration
from rmw_manycore_py.advice.problem import ConstraintKind
from rmw_manycore_py.advice.solving import Effort
from rmw_manycore_py.advice.weights import OBJECTIVES, Objective
from rmw_manycore_py.cli.common.chain import ChainText
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option, number_option
from rmw_manycore_py.cli.common.output_file import OutputFile, writing
from rmw_manycore_py.cli.common.printing import (
    echo,
    new_table,
    print_json,
    print_table,
)
from rmw_manycore_py.mapfile.format.document import read_text
from rmw_manycore_py.prediction.target_file import target_named
from rmw_manycore_py.profile.files import load

_NODES = "NODE,.."


@click.command(
    "advise",
    epilog=examples(
        "manycore advise map.yaml --profile app.profile.json -o advised.yaml",
        "manycore advise map.yaml --profile app.profile.json --chain '/image /small'",
        "manycore advise map.yaml --profile app.profile.json --apart 'planner,backup_*'",
        "manycore advise map.yaml --profile app.profile.json --platform host",
    ),
)
@mapfile_argument()
@click.option(
    "--profile",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="Profile of the application: from manycore profile.",
)
@click.option(
    "--objective",
    type=click.Choice(OBJECTIVES),
    default="p99",
    show_default=True,
    help="Of chains: p99, maximum, jitter. Or the busiest CPU, or bytes between clusters.",
)
@click.option(
    "--chain",
    type=ChainText(),
    help="Topics of the chain that matters, separated by spaces.  [default: all chains]",
)
@click.option(
    "--platform",
    "platform_name",
    metavar="NAME",
    help="Judge on host, coolidge, bostan, or a file's platform.  [default: MAPFILE's]",
)
@click.option("--fix", multiple=True, metavar=_NODES, help="Leave these nodes where they are.")
@click.option("--together", multiple=True, metavar=_NODES, help="Put them into one cluster.")
@click.option(
    "--apart", multiple=True, metavar=_NODES, help="Put each of them into another cluster."
)
@click.option(
    "--no-priorities",
    is_flag=True,
    help="Give the nodes of the chain no real-time priorities on a host.",
)
@number_option(
    "--candidates", within=(1, 100), default=8, metavar="N", help="Mappings to simulate."
)
@number_option(
    "--effort",
    within=(0.1, 10_000.0),
    default=20.0,
    metavar="S",
    help="Search budget in seconds of a reference CPU; deterministic.",
)
@number_option(
    "--duration",
    "duration_s",
    within=(0.1, 3600.0),
    default=10.0,
    metavar="S",
    help="Simulated time of each mapping.",
)
@number_option(
    "--seed", within=(0, 2**31 - 1), default=0, metavar="N", help="Seed of the random numbers."
)
@click.option("-o", "--output", type=OutputFile(), help="Mapfile to write.")
@click.option(
    "--isolated-executor",
    "configuration",
    type=OutputFile(".yaml", ".yml"),
    help="Also write the placement for TIER IV's CallbackIsolatedExecutor.",
)
@click.option(
    "--template",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Ids of callback groups: template.yaml of its thread_configurator_node --prerun.",
)
@json_option
def command(
    mapfile: Path,
    profile: Path,
    objective: Objective,
    chain: str | None,
    platform_name: str | None,
    fix: tuple[str, ...],
    together: tuple[str, ...],
    apart: tuple[str, ...],
    no_priorities: bool,
    candidates: int,
    effort: float,
    duration_s: float,
    seed: int,
    output: Path | None,
    configuration: Path | None,
    template: Path | None,
    as_json: bool,
) -> None:
    """Advise which node belongs on which core.

    For the nodes of MAPFILE, a solver finds mappings that satisfy all constraints. The best of them
    in a simulation of the profile is written. NODE is a name or a pattern. The new mapfile has the
    comments of the old one. Names of files stay relative to it.
    """
    given: dict[ConstraintKind, tuple[str, ...]] = {
        "fix": fix, "together": together, "apart": apart,
    }  # fmt: skip
    request = Request(
        objective=objective,
        chain=tuple((chain or "").split()),
        wishes=tuple((kind, text) for kind, texts in given.items() for text in texts),
        effort=Effort(candidates, effort, seed),
        in_real_time=not no_priorities,
        duration_s=duration_s,
        target=target_named(platform_name) if platform_name else None,
    )
    known = load(profile)
    advice = advise(output or mapfile, read_text(mapfile), known, request, _report)
    best = advice.best.candidate
    if output is not None:
        _write(output, best.text)
    if configuration is not None:
        _write(configuration, thread_configuration(best.placement, known, template))
    if as_json:
        print_json(as_data(advice))
        return
    _show(advice)
    for sentence in sentences(advice):
        echo(sentence)


def _write(path: Path, text: str) -> None:
    with writing(path):
        path.write_text(text)


def _report(text: str) -> None:
    if sys.stderr.isatty():
        echo(text, err=True)


def _show(advice: Advice) -> None:
    table = new_table("mapping", "#messages/s between clusters", "#score")
    for row in as_data(advice)["candidates"]:
        missing = len(row["incomplete"])
        score = f"{missing} incomplete" if missing else f"{row['score']:.3g}"
        table.add_row(row["name"], f"{row['messages_per_s']:.1f}", score)
    print_table(table)
    echo()
