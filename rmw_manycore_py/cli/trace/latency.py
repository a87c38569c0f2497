# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace latency`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.chain import chains_option
from rmw_manycore_py.cli.common.options import examples, json_option, platform_option
from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.common.printing import echo, escaped, new_table, print_json, print_table
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.cli.trace.chart import plot
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import load
from rmw_manycore_py.trace.latency import ChainLatency, latencies
from rmw_manycore_py.trace.recorded import looked_at


@click.command(
    "latency",
    epilog=examples(
        "manycore trace latency trace.json",
        "manycore trace latency --chain '/image /image_small' trace.json",
        "manycore trace latency --live",
    ),
)
@click.argument("file", required=False, type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--live", is_flag=True, help="Use the events recorded so far, without consuming them."
)
@chains_option
@click.option(
    "--plot", "picture", type=OutputFile(".png", ".svg", ".pdf"), help="Also draw a chart."
)
@json_option
@platform_option
def command(
    file: Path | None,
    live: bool,
    chains: tuple[str, ...],
    picture: Path | None,
    as_json: bool,
    platform: str,
) -> None:
    """Show latency through chains of nodes, hop by hop.

    A chain continues where a node publishes while it handles a message it has
    taken.
    """
    if live == (file is not None):
        raise click.UsageError("expected either FILE or --live")
    found = evaluated(load(file) if file else _recorded(platform), chains)
    if picture is not None:
        plot(found, picture)
    if as_json:
        print_json([one.row() for one in found])
        return
    if not found:
        echo("no message went through a chain")
    for number, one in enumerate(found):
        if number:
            echo()
        _show(one)


def evaluated(trace: Trace, chains: tuple[str, ...] = ()) -> list[ChainLatency]:
    """Return the latency of the chains with these topics; default: all chains."""
    messages = Messages(trace)
    wanted = [tuple(chain.split()) for chain in chains] or messages.chains
    found = latencies(messages, wanted)
    for chain in wanted if chains else ():
        if not any(one.chain == chain for one in found):
            known = "; ".join(" ".join(one) for one in messages.chains) or "none"
            raise ManycoreError(
                f"no message went through {' '.join(chain)}; the chains of the trace: {known}"
            )
    return found


def _recorded(platform: str) -> Trace:
    require_platform(platform)
    return looked_at(platform)


def _show(one: ChainLatency) -> None:
    echo(escaped(one.name))
    table = new_table("  part", "#count", "#p50", "#p99", "#max")
    for part in one.parts:
        count = len(part.samples_us)
        shares = (0.5, 0.99, 1)
        values = (f"{part.quantile(share):.1f} us" if count else "-" for share in shares)
        table.add_row(f"  {part.name}", str(count), *values)
    print_table(table)
