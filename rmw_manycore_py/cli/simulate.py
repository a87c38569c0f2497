# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore simulate`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.chain import chains_option
from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option, number_option
from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.common.printing import (
    echo,
    escaped,
    new_table,
    print_json,
    print_notices,
    print_table,
    size_text,
)
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.missing_library import SIMPY, require
from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.prediction import Prediction, Target, predict, sites_of
from rmw_manycore_py.prediction.json_data import as_data
from rmw_manycore_py.prediction.sites import Sites
from rmw_manycore_py.prediction.sweep import sweep_of
from rmw_manycore_py.prediction.target_file import target_named
from rmw_manycore_py.profile.files import load
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.trace.atomic_file import require_writable
from rmw_manycore_py.trace.files import save
from rmw_manycore_py.trace.formats import SUFFIXES


@click.command(
    "simulate",
    epilog=examples(
        "manycore simulate talker_listener --profile app.profile.json",
        "manycore simulate image_pipeline --profile images.profile.json --platform coolidge",
        "manycore simulate whill --profile whill.profile.json --trace predicted.json",
    ),
)
@mapfile_argument()
@click.option(
    "--profile",
    "profile_path",
    required=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="Profile of the application, from manycore profile.",
)
@click.option(
    "--platform",
    "platform_name",
    default="host",
    show_default=True,
    metavar="NAME",
    help="host, coolidge, bostan, or a file with the parameters of another platform.",
)
@duration_option(60.0, "Simulate this many seconds.", endless=False)
@number_option("--seed", within=(0, None), default=0, help="Seed of the random numbers.")
@chains_option
@click.option(
    "--deadline",
    "deadline_ms",
    type=FiniteRange(min=0, min_open=True),
    metavar="MS",
    help="Count messages that take longer through a chain.",
)
@click.option(
    "--trace",
    "trace_path",
    type=OutputFile(*SUFFIXES),
    help="Also write the simulated run as a trace.",
)
@json_option
def command(
    mapfile: Path,
    profile_path: Path,
    platform_name: str,
    duration_s: float,
    seed: int,
    chains: tuple[str, ...],
    deadline_ms: float | None,
    trace_path: Path | None,
    as_json: bool,
) -> None:
    """Predict how MAPFILE runs, from a profile.

    Chains, loads, memory, losses and missed periods of a simulated run. Where a platform's
    parameters are not published, the result is a sweep over them.
    """
    require(SIMPY)
    if trace_path is not None:
        require_writable(trace_path)
    placement = resolve(load_mapfile(mapfile), to_start=False)
    profile, target = load(profile_path), target_named(platform_name)
    wanted = [tuple(chain.split()) for chain in chains] or None
    options: dict[str, Any] = {"seed": seed, "duration_s": duration_s, "chains": wanted}
    sites = sites_of(placement)
    print_notices(_of_unknown_nodes(sites, profile))
    found = [
        (
            label,
            predict(sites, profile, one, **options, is_traced=_is_saved(trace_path, one, target)),
        )
        for label, one in sweep_of(target)
    ]
    if wanted and not any(prediction.chains for _, prediction in found):
        raise ManycoreError(f"no message went through {', '.join(chains)}")
    if trace_path is not None:
        _save(found, trace_path)
    if as_json:
        print_json(_data(target, found, deadline_ms))
    elif target.unknown:
        _show_sweep(target, found, deadline_ms)
    else:
        _show(found[0][1], deadline_ms)


def _of_unknown_nodes(sites: Sites, profile: Profile) -> Iterator[str]:
    if missing := sorted(set(sites.nodes) - {node.name for node in profile.nodes}):
        yield f"not in the profile, so simulated as idle: {', '.join(missing)}"


def _is_saved(path: Path | None, one: Target, target: Target) -> bool:
    """Return whether a run of a sweep is saved: that with the default values."""
    return path is not None and one.speed == target.speed


def _save(found: Sequence[tuple[str, Prediction]], path: Path) -> None:
    label, trace = next((label, one.trace) for label, one in found if one.trace is not None)
    save(trace, path)
    assumed = f" ({label})" if label else ""
    print_notices([f"wrote {path}{assumed}"])


def _data(
    target: Target, found: Sequence[tuple[str, Prediction]], deadline_ms: float | None
) -> dict[str, Any]:
    if not target.unknown:
        return as_data(found[0][1], deadline_ms)
    return {
        "platform": target.name,
        "unknown": list(target.unknown),
        "sweep": [{"if": label, **as_data(one, deadline_ms)} for label, one in found],
    }


def _show_sweep(
    target: Target, found: Sequence[tuple[str, Prediction]], deadline_ms: float | None
) -> None:
    echo(f"{target.name}: no value is published for {', '.join(target.unknown)}.")
    echo("Each line only holds if its assumption does; speed 1 is that of the profile's machine.")
    late = ("#late",) if deadline_ms else ()
    for index in range(max((len(one.chains) for _, one in found), default=0)):
        shown = [(label, one) for label, one in found if index < len(one.chains)]
        echo(f"\n{escaped(shown[0][1].chains[index].name)}")
        table = new_table("  if", "#count", "#p50 ms", "#p99 ms", "#max ms", *late, "#busiest CPU")
        for label, one in shown:
            chain = one.chains[index]
            missed = (str(chain.late(deadline_ms)),) if deadline_ms else ()
            table.add_row(
                f"  {label}",
                str(len(chain.samples_us)),
                *(_ms(chain.quantile_us(share)) for share in (0.5, 0.99, 1.0)),
                *missed,
                f"{one.busiest:.0%}",
            )
        print_table(table)


def _show(one: Prediction, deadline_ms: float | None) -> None:
    late = ("#late",) if deadline_ms else ()
    echo(f"simulated {one.duration_s:g} s, {one.executions} callbacks; times in microseconds")
    table = new_table("#count", "#p50", "#p99", "#max", *late, "chain")
    for chain in one.chains:
        quantiles = (chain.quantile_us(share) for share in (0.5, 0.99, 1.0))
        missed = (str(chain.late(deadline_ms)),) if deadline_ms else ()
        texts = ("-" if value is None else f"{value:.1f}" for value in quantiles)
        table.add_row(str(len(chain.samples_us)), *texts, *missed, chain.name)
    print_table(table)
    _show_loads(one)
    _show_losses(one)


def _show_loads(one: Prediction) -> None:
    echo("\nload")
    table = new_table("#cluster", "core", "#messages/s", "#CPU", "nodes")
    for core in one.cores:
        names = ", ".join(core.nodes)
        place = map(str, core.core)
        table.add_row(*place, "", f"{core.cpu_share:.1%}", names)
    for thread in one.receive_threads:
        rate = f"{thread.messages_per_s:.1f}"
        table.add_row(str(thread.cluster), "receive thread", rate, f"{thread.cpu_share:.1%}", "")
    print_table(table)
    if one.cpus:
        echo("\nCPUs of this host")
        table = new_table("#CPU", "#load")
        for cpu in one.cpus:
            table.add_row(str(cpu.cpu), f"{cpu.cpu_share:.1%}")
        print_table(table)
    echo("\nmemory")
    table = new_table("#cluster", "#peak")
    for cluster, size_bytes in sorted(one.smem_bytes.items()):
        table.add_row(str(cluster), size_text(size_bytes))
    print_table(table)
    if one.links:
        echo("\nbetween clusters")
        table = new_table("from", "to", "#bytes/s", "#busy")
        for link in one.links:
            table.add_row(*link.link, size_text(round(link.bytes_per_s)), f"{link.share:.1%}")
        print_table(table)


def _show_losses(one: Prediction) -> None:
    for queue in one.queues:
        what = f"lost {queue.lost}" if queue.lost else "was full"
        echo(f"queue of {queue.topic} in {queue.node}: depth {queue.depth}, {what}")
    for topic, count in one.overwritten.items():
        echo(f"topic DSM of {topic}: {count} overwritten before all had read them")
    for timer in one.timers:
        echo(f"timer of {timer.node}, {timer.period_us / 1e3:g} ms: missed {timer.missed} periods")


def _ms(time_us: float | None) -> str:
    return "-" if time_us is None else f"{time_us / 1e3:.2f}"
