# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench advise`."""

from __future__ import annotations

import math
from pathlib import Path

import click
from rich.console import Console

from rmw_manycore_py.bench.advise.contest import Contest, Mapping, contest
from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.predict.runs import Plan
from rmw_manycore_py.cli.bench.options import mapping_runs_options
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.missing_library import ORTOOLS, SIMPY, require
from rmw_manycore_py.mapfile.installed import find_mapfile

GOALS = {"of_median": 0.8, "of_best": 1.05, "of_worst_case": 1 / 3}
_MEANINGS = {
    "of_median": "p99 / median of the random mappings",
    "of_best": "p99 / best random mapping",
    "of_worst_case": "worst case beside busy loops / that of MAPFILE",
}


@click.command(
    "advise",
    epilog=examples(
        "manycore bench advise -o build/advise",
        "manycore bench advise map.yaml --chain '/image /small' --mappings 8 -o build/advise",
    ),
)
@click.argument("mapfile", default="autoware_reference", metavar="[MAPFILE]")
@click.option(
    "--chain", default="", help="Topics of the chain, separated by spaces.  [default: the longest]"
)
@mapping_runs_options(min_mappings=1, repetitions=3)
@json_option
def command(
    mapfile: str,
    chain: str,
    mappings: int,
    repetitions: int,
    duration_s: float,
    seed: int,
    output: Path,
    as_json: bool,
) -> None:
    """Compare an advised mapping with random ones.

    Records a profile of MAPFILE, by default of autoware_reference, asks for advice, and runs the
    advised mapping, MAPFILE and random mappings. The first two also run beside a busy loop per
    CPU. An interrupted benchmark resumes from --output.
    """
    require(ORTOOLS)
    require(SIMPY)
    path = find_mapfile(mapfile)
    if path is None:
        raise ManycoreError(f"there is no mapfile {mapfile}", EXIT_BAD_INPUT)
    plan = Plan(path, output / path.stem, mappings, repetitions, duration_s, seed)
    with Console(stderr=True).status("bench advise") as status:
        found = contest(plan, tuple(chain.split()), status.update)
    if as_json:
        print_json(_data(found))
        return
    _show(found)


def _data(found: Contest) -> dict[str, object]:
    return {
        "machine": machine_header(),
        "chain": found.chain,
        "p99_us": {one.name: _finite(one.p99_us(found.chain)) for one in _unloaded(found)},
        "worst_loaded_us": {
            one.name: _finite(one.worst_us(found.chain))
            for one in (found.loaded_now, found.loaded_advised)
        },
        **{name: _finite(getattr(found, name)) for name in GOALS},
    }


def _finite(value: float) -> float | None:
    """Return None for the time of an incomplete chain, which JSON cannot express."""
    return value if math.isfinite(value) else None


def _unloaded(found: Contest) -> tuple[Mapping, ...]:
    return (found.advised, found.now, *found.random)


def _show(found: Contest) -> None:
    echo(found.chain)
    table = new_table("mapping", "#p99 ms", "#worst ms", "#worst ms beside busy loops")
    loaded = {found.advised.name: found.loaded_advised, found.now.name: found.loaded_now}
    for one in sorted(_unloaded(found), key=lambda one: one.p99_us(found.chain)):
        beside = loaded.get(one.name)
        table.add_row(
            one.name,
            f"{one.p99_us(found.chain) / 1e3:.2f}",
            f"{one.worst_us(found.chain) / 1e3:.2f}",
            f"{beside.worst_us(found.chain) / 1e3:.2f}" if beside else "",
        )
    print_table(table)
    for name, goal in GOALS.items():
        value = getattr(found, name)
        verdict = "reached" if value <= goal else "missed"
        echo(f"{_MEANINGS[name]}: {value:.2f} (goal {goal:.2f}: {verdict})")
