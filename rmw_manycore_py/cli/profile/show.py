# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore profile show`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from rmw_manycore_py.cli.common.finite_range import WholeRange
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.profile.files import load
from rmw_manycore_py.profile.model import Callback, Distribution, Profile
from rmw_manycore_py.profile.summary import summary_of


@click.command(
    "show",
    epilog=examples(
        "manycore profile show app.profile.json",
        "manycore profile show app.profile.json --json | jq .cpus_busy",
    ),
)
@click.argument("profile", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--busiest",
    type=WholeRange(min=0),
    default=10,
    show_default=True,
    metavar="N",
    help="List the N callbacks with the highest load.",
)
@json_option
def command(profile: Path, busiest: int, as_json: bool) -> None:
    """Summarise a profile; list its busiest callbacks."""
    loaded = load(profile)
    if as_json:
        print_json(summary_of(loaded))
        return
    _show_summary(summary_of(loaded))
    ranked = sorted(loaded.callbacks, key=lambda one: -one.load_cpus)[:busiest]
    if ranked:
        echo()
        _show_callbacks(loaded, ranked)


def _show_summary(summary: dict[str, Any]) -> None:
    table = new_table("", "#")
    for name, value in summary.items():
        text = "unknown" if value is None else f"{value:.2f}" if isinstance(value, float) else value
        table.add_row(name.replace("_", " "), str(text))
    print_table(table)


def _show_callbacks(profile: Profile, callbacks: list[Callback]) -> None:
    table = new_table("node", "callback", "#rate Hz", "#mean", "#p99", "#max", "#on CPU", "#CPUs")
    for one in callbacks:
        node = "" if one.node is None else profile.nodes[one.node].name
        times = [_ms(profile, one.wall_ns, share) for share in (None, 0.99, 1.0)]
        rate = "" if one.rate_hz is None else f"{one.rate_hz:.1f}"
        table.add_row(node, _trigger(one), rate, *times, _on_cpu(one), f"{one.load_cpus:.3f}")
    print_table(table)


def _trigger(one: Callback) -> str:
    if one.kind == "timer" and one.period_ns is not None:
        return f"timer {one.period_ns / 1e6:g} ms"
    return f"{one.kind} {one.trigger}".rstrip()


def _on_cpu(one: Callback) -> str:
    share = one.cpu_share
    return "" if share is None else f"{share:.0%}"


def _ms(profile: Profile, times_ns: Distribution | None, share: float | None) -> str:
    if times_ns is None:
        return ""
    if share is None:
        return f"{times_ns.mean / 1e6:.3f} ms"
    time_ns = np.interp(share, profile.quantile_shares, times_ns.quantiles)
    return f"{time_ns / 1e6:.3f} ms"
