# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench rmw`."""

from __future__ import annotations

from typing import Any

import click

from rmw_manycore_py.bench import fan_out, first_message, round_trip, steady_state, throughput
from rmw_manycore_py.cli.bench.answer import answer
from rmw_manycore_py.cli.bench.options import bench_options

QUESTIONS = {
    "round-trip": round_trip.QUESTION,
    "throughput": throughput.QUESTION,
    "fan-out": fan_out.QUESTION,
    "first-message": first_message.QUESTION,
    "steady-state": steady_state.QUESTION,
}


@click.command("rmw")
@click.argument("questions", nargs=-1, type=click.Choice(list(QUESTIONS)))
@bench_options
def command(questions: tuple[str, ...], **options: Any) -> None:
    """Measure rmw_publish, rmw_wait and rmw_take.

    By native programs; default: all QUESTIONS.
    """
    answer([QUESTIONS[name] for name in questions or QUESTIONS], **options)
