# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace draw`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.chain import ChainText
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import OutputFile
from rmw_manycore_py.cli.trace.timeline import draw
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.chains import Messages, Passage
from rmw_manycore_py.trace.files import load


@click.command(
    "draw",
    epilog=examples(
        "manycore trace draw -o message.png trace.json",
        "manycore trace draw --chain '/image /image_small' -o message.svg trace.json",
    ),
)
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "-o",
    "--output",
    required=True,
    type=OutputFile(".png", ".svg", ".pdf"),
    help="File to write.",
)
@click.option(
    "--chain",
    type=ChainText(),
    help="Topics of the chain, separated by spaces; default: the longest.",
)
def command(file: Path, output: Path, chain: str | None) -> None:
    """Draw the path of one message through a chain.

    The message with the median latency.
    """
    trace = load(file)
    draw(trace, _median_passage(Messages(trace), chain), output)


def _median_passage(messages: Messages, wanted: str | None) -> Passage:
    chain = tuple(wanted.split()) if wanted else max(messages.chains, key=len, default=())
    passages = messages.passages(chain) if chain else []
    if not passages:
        known = "; ".join(" ".join(one) for one in messages.chains) or "none"
        raise ManycoreError(
            f"no message went through {' '.join(chain) or 'a chain'}; "
            f"the chains of the trace: {known}"
        )
    passages.sort(key=lambda one: one.callback_ns[-1] - one.published_ns[0])
    return passages[len(passages) // 2]
