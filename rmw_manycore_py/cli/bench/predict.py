# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench predict`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from statistics import median
from typing import Any

import click
from rich.console import Console

from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.predict.errors import MappingError, Order, error_of, order_of
from rmw_manycore_py.bench.predict.halves import PartErrors, Parts, parts_of
from rmw_manycore_py.bench.predict.reports import ReportedChain, reported_chains
from rmw_manycore_py.bench.predict.runs import Compared, Plan, compared
from rmw_manycore_py.cli.bench.driven import driven
from rmw_manycore_py.cli.bench.options import mapping_runs_options
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.missing_library import SIMPY, require
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.profile.files import load

_PARTS_S = 20.0  # simulated
APPLICATIONS = ("autoware_reference", "image_pipeline", "whill")


@click.command(
    "predict",
    epilog=examples(
        "manycore bench predict -o build/predict",
        "manycore bench predict image_pipeline --mappings 4 --repetitions 2 -o build/predict",
        "manycore bench predict --report caret_report --mappings 0 -o build/predict",
        "manycore bench predict --parts a.json b.json --mappings 0 -o build/predict",
    ),
)
@click.argument("mapfiles", nargs=-1, metavar="[MAPFILE]...")
@mapping_runs_options(min_mappings=0, repetitions=5)
@click.option(
    "--report",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Also predict the chains of a CARET report, whose latencies it holds.",
)
@click.option(
    "--parts",
    nargs=2,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FIRST SECOND",
    help="Also predict the second of two imported profiles from the first.",
)
@json_option
def command(
    mapfiles: tuple[str, ...],
    mappings: int,
    repetitions: int,
    duration_s: float,
    seed: int,
    report: Path | None,
    parts: tuple[Path, Path] | None,
    output: Path,
    as_json: bool,
) -> None:
    """Compare predictions with measurements.

    Records a profile of each MAPFILE, by default of autoware_reference, image_pipeline and whill
    with its laptop as a node, runs its nodes on random cores and host CPUs, and predicts these
    runs from the profile.
    """
    require(SIMPY)
    progress = Console(stderr=True)
    found: dict[str, list[Compared]] = {}
    with progress.status("bench predict") as status:
        for name in (mapfiles or APPLICATIONS) if mappings else ():
            mapfile = find_mapfile(name)
            if mapfile is None:
                raise ManycoreError(f"there is no mapfile {name}", EXIT_BAD_INPUT)
            directory = output.absolute() / mapfile.stem
            directory.mkdir(parents=True, exist_ok=True)
            complete = driven(mapfile, directory)
            plan = Plan(complete, directory, mappings, repetitions, duration_s, seed)
            found[mapfile.stem] = compared(plan, status.update)
        chains = reported_chains(report, seed) if report else []
        halves = _parts(*parts, seed) if parts else None
    rows = {name: _row(of) for name, of in found.items()}
    if as_json:
        print_json(
            {
                "machine": machine_header(),
                "applications": rows,
                "report": [asdict(one) for one in chains],
                "parts": asdict(halves) if halves else None,
            }
        )
        return
    for name, of in found.items():
        _show(name, of)
    if chains:
        _show_report(chains)
    if halves:
        _show_parts("from publish to callback", halves.queueing)
    if halves and halves.chains:
        _show_parts("along chains", halves.chains)


def _parts(first: Path, second: Path, seed: int) -> Parts:
    return parts_of(load(first), load(second), _PARTS_S, seed)


def _row(mappings: Sequence[Compared]) -> dict[str, Any]:
    errors = [error_of(one) for one in mappings]
    light = [one for one in errors if one.is_light]
    return {
        "mappings": [{**asdict(one), "is_light": one.is_light} for one in errors],
        "all": _summary(errors),
        "light": _summary(light),
        "order": asdict(order_of(mappings)),
    }


def _summary(errors: Sequence[MappingError]) -> dict[str, Any]:
    p50 = [abs(error) for one in errors for error in one.p50]
    p99 = [abs(error) for one in errors for error in one.p99]
    repeated_p50 = [abs(error) for one in errors for error in one.repeated_p50]
    repeated_p99 = [abs(error) for one in errors for error in one.repeated_p99]
    return {
        "mappings": len(errors),
        "p50_median": median(p50) if p50 else None,
        "p50_max": max(p50, default=None),
        "p99_median": median(p99) if p99 else None,
        "repeated_p50_median": median(repeated_p50) if repeated_p50 else None,
        "repeated_p50_max": max(repeated_p50, default=None),
        "repeated_p99_median": median(repeated_p99) if repeated_p99 else None,
        "load_points_max": max((one.load_points for one in errors), default=None),
    }


def _show(name: str, mappings: Sequence[Compared]) -> None:
    echo(f"\n{name}")
    table = new_table(
        "#mapping", "#load", "#chains", "#p50 error", "#largest", "#p99", "#load points", "#others"
    )
    errors = [error_of(one) for one in mappings]
    for one in errors:
        p50, p99 = ([abs(error) for error in found] for found in (one.p50, one.p99))
        table.add_row(
            str(one.number),
            f"{one.load:.0%}",
            str(len(p50)),
            _percent(median(p50) if p50 else None),
            _percent(max(p50, default=None)),
            _percent(median(p99) if p99 else None),
            f"{one.load_points:.1f}",
            f"{one.others:.0%}",
        )
    print_table(table)
    for label, chosen in (
        ("all mappings", errors),
        ("under 60 % load", [one for one in errors if one.is_light]),
    ):
        found = _summary(chosen)
        echo(
            f"{label} ({found['mappings']}): p50 {_percent(found['p50_median'])} in the median, "
            f"{_percent(found['p50_max'])} at most; p99 {_percent(found['p99_median'])}; "
            f"a run from the others: p50 {_percent(found['repeated_p50_median'])}, "
            f"{_percent(found['repeated_p50_max'])} at most, "
            f"p99 {_percent(found['repeated_p99_median'])}"
        )
    echo(_order_text(order_of(mappings)))


def _order_text(order: Order) -> str:
    if order.tau is None:
        return "order: no pair of mappings whose intervals are apart"
    return f"order: Kendall tau {order.tau:.2f} over {order.pairs} pairs"


def _show_report(chains: Sequence[ReportedChain]) -> None:
    echo("\nCARET report, best case p50")
    table = new_table("chain", "#measured ms", "#predicted ms", "#error")
    for one in chains:
        texts = (f"{one.measured_ms:.1f}", f"{one.predicted_ms:.1f}", f"{one.error:+.1%}")
        table.add_row(one.chain, *texts)
    print_table(table)


def _show_parts(what: str, found: PartErrors) -> None:
    echo(
        f"\n{what}, {found.subscriptions} subscriptions of both parts "
        f"({found.only_in_second} others): median error {_percent(found.error)}; "
        f"repeating the first part {_percent(found.repeated)}"
    )


def _percent(value: float | None) -> str:
    return "-" if value is None else f"{value:.1%}"
