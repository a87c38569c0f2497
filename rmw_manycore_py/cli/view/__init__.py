# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore view`."""

from __future__ import annotations

import time
import webbrowser
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import click

from rmw_manycore_py.cli.common.looking import look_at
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.output_file import OutputFile, writing
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.look.watch import Look, Watch
from rmw_manycore_py.picture.chip import Chip

DEFAULT_PORT = 8642


@click.command(
    "view",
    epilog=examples(
        "manycore view", "manycore view --port 0 --open", "manycore view --once -o chip.svg"
    ),
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=DEFAULT_PORT,
    show_default=True,
    help="Port on 127.0.0.1; 0 for any that is free.",
)
@click.option("--open", "opens", is_flag=True, help="Open the page in the browser, too.")
@click.option(
    "--once", is_flag=True, help="Draw the picture into a file instead, without a browser."
)
@click.option("-o", "--output", type=OutputFile(".svg"), help="With --once: the file.")
@click.option(
    "--period",
    "period_s",
    type=click.FloatRange(min=0.1),
    default=0.5,
    show_default=True,
    help="Seconds between two looks; with --once also what rates are taken over.",
)
@platform_option
def command(
    platform: str, port: int, opens: bool, once: bool, output: Path | None, period_s: float
) -> None:
    """Show the chip in the browser: clusters, cores, nodes, and the topics between them.

    The platform may start and end meanwhile. Looking does not join it, and wakes no node.
    """
    if once != (output is not None):
        raise click.UsageError("--once and -o FILE go together")
    if output is not None:
        _draw(platform, output, period_s)
        return

    def announce(link: str) -> None:
        click.echo(f"platform {platform}: {link}")
        click.echo(
            "The link holds a token that gives access to the platform. Ctrl-C ends.", err=True
        )
        if opens:
            webbrowser.open(link)

    _server()(platform, port, period_s, announce)


def _draw(platform: str, output: Path, period_s: float) -> None:
    require_platform(platform)
    with closing(Watch(platform)) as watch:
        look_at(platform, watch)
        time.sleep(period_s)
        look = look_at(platform, watch)
    with writing(output):
        output.write_text(_svg(look))


def _svg(look: Look) -> str:
    chip = Chip.of(look)
    return chip.svg(chip.marks(look))


def _server() -> Callable[[str, int, float, Callable[[str], None]], None]:
    try:
        from rmw_manycore_py.view.server import serve
    except ImportError as error:
        raise ManycoreError(
            f"the server cannot be loaded ({error}). The page needs it: "
            "pip install 'rmw-manycore[view]'; --once does without"
        ) from error
    return serve
