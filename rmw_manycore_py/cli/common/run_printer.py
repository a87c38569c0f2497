# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Human-readable output of `manycore run`: node output behind coloured names."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle

import click

from rmw_manycore_py.cli.common.printing import (
    echo,
    new_table,
    print_table,
    printable,
    size_text,
)
from rmw_manycore_py.launch.event_text import SUPERVISOR, text_of
from rmw_manycore_py.launch.events import (
    Ended,
    Event,
    Finished,
    Notice,
    Output,
    Platform,
    Restarting,
    SignalEscalated,
)
from rmw_manycore_py.platform.topology import host_cpu_text

COLOURS = (
    "cyan",
    "yellow",
    "green",
    "magenta",
    "blue",
    "bright_cyan",
    "bright_yellow",
    "bright_green",
    "bright_magenta",
    "bright_blue",
)  # red is for failures
_WARNINGS = (Notice, SignalEscalated, Restarting)


class RunPrinter:
    """Prints events as they arrive.

    :param nodes: nodes that get a colour and define the column width; others may follow.
    """

    def __init__(self, nodes: Sequence[str] = ()) -> None:
        # Helper processes print little, so their longer names may exceed the column.
        named = [name for name in nodes if not name.startswith("(")]
        self._width = max(len(name) for name in (*named, SUPERVISOR))
        self._colours = cycle(COLOURS)
        self._prefixes = {name: self._new_prefix(name) for name in nodes}
        self._failures: list[Ended] = []

    def report(self, event: Event) -> None:
        """Print an event."""
        if isinstance(event, Output):
            click.echo(self._prefix(event.node) + event.line)
        elif isinstance(event, Platform):
            _print_platform(event)
        elif isinstance(event, Ended):
            self._ended(event)
        elif isinstance(event, Finished):
            self._finished()
        elif (text := text_of(event)) is not None:
            self.print_line(text, fg="yellow" if isinstance(event, _WARNINGS) else None)

    def _prefix(self, name: str) -> str:
        if name not in self._prefixes:
            self._prefixes[name] = self._new_prefix(name)
        return self._prefixes[name]

    def _new_prefix(self, name: str) -> str:
        return click.style(f"{name:<{self._width}} | ", fg=next(self._colours))

    def print_line(self, text: str, fg: str | None = None) -> None:
        """Print a line of the run itself, without a node name."""
        click.secho(f"{SUPERVISOR:<{self._width}} | {printable(text)}", fg=fg, bold=fg is None)

    def _ended(self, event: Ended) -> None:
        failed = event.state == "failed"
        if failed:
            self._failures.append(event)
        self.print_line(text_of(event) or "", fg="red" if failed else None)

    def _finished(self) -> None:
        """Repeat which nodes failed and why: the reason may have scrolled away."""
        for failure in self._failures:
            click.secho(f"\n{failure.node} failed: {printable(failure.reason)}", fg="red", err=True)
            for line in failure.last_lines:
                click.echo(f"    {line}", err=True)


def _print_platform(event: Platform) -> None:
    echo(
        f"platform {event.name} ({event.profile}): {event.clusters} clusters x "
        f"{event.cores_per_cluster} cores, SMEM {size_text(event.smem_size)} each"
    )
    table = new_table("node", "#cluster", "#core", "#host CPU")
    for row in event.cores:
        table.add_row(row.node, str(row.cluster), str(row.core), host_cpu_text(row.host_cpu))
    print_table(table)
