# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore view`."""

from __future__ import annotations

import time
import webbrowser
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from rmw_manycore_py.cli.common.looking import look_at
from rmw_manycore_py.cli.common.options import examples, number_option, platform_option
from rmw_manycore_py.cli.common.output_file import OutputFile, writing
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.errors.missing_library import WEB_SERVER, require_installed
from rmw_manycore_py.picture.chip import Chip
from rmw_manycore_py.platform.monitor.watch import Look, Watch
from rmw_manycore_py.view.listener import listen

if TYPE_CHECKING:
    from rmw_manycore_py.view.trace_run import TraceRun

DEFAULT_PORT = 8642


@click.command(
    "view",
    epilog=examples(
        "manycore view",
        "manycore view --port 0 --open",
        "manycore view --once -o chip.svg",
        "manycore view --file measured.json --file simulated.json",
    ),
)
@click.option(
    "--file",
    "files",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="Show a saved trace of a real or simulated run, not the platform. "
    "Repeat it to show several, one above another.",
)
@number_option(
    "--port", within=(0, 65535), default=DEFAULT_PORT, help="Port on 127.0.0.1; 0 picks a free one."
)
@click.option("--open", "opens", is_flag=True, help="Also open the page in the browser.")
@click.option("--once", is_flag=True, help="Write the picture to a file instead of serving it.")
@click.option("-o", "--output", type=OutputFile(".svg"), help="With --once: file to write.")
@number_option(
    "--period",
    "period_s",
    within=(0.1, None),
    default=0.5,
    help="Seconds between updates; with --once, the time over which rates are measured.",
)
@platform_option
def command(
    platform: str,
    files: tuple[Path, ...],
    port: int,
    opens: bool,
    once: bool,
    output: Path | None,
    period_s: float,
) -> None:
    """Show the chip in the browser.

    Clusters, cores, nodes, and the topics between them. The platform may start and end
    meanwhile. Viewing does not join it and wakes no node; messages and parameters that the page
    is asked for come from processes that do.
    """
    if once != (output is not None):
        raise click.UsageError("--once and -o FILE require each other")
    if output is not None and len(files) > 1:
        raise click.UsageError("--once draws one --file")
    if files:
        _refuse("is for a platform, not for --file", platform="--platform", period_s="--period")
    if once:
        _refuse("is for a page, not for --once", port="--port", opens="--open")
    if output is None:
        require_installed(WEB_SERVER)
    runs = [_run_in(file) for file in files]
    if output is not None:
        if runs:
            _write(runs[0].whole, output)
        else:
            _draw(platform, output, period_s)
        return

    listener = listen(port)
    # Before the web server is loaded: the browser connects and draws its window meanwhile.
    echo(f"{', '.join(map(str, files)) or f'platform {platform}'}: {listener.link}")
    what = "these files" if files else "the platform"
    echo(f"The link holds a token that gives access to {what}. Ctrl-C stops.", err=True)
    if opens:
        webbrowser.open(listener.link)
    with listener.socket:
        from rmw_manycore_py.view.server import serve, serve_traces

        if runs:
            serve_traces(runs, listener)
        else:
            serve(platform, listener, period_s)


def _refuse(why: str, **options: str) -> None:
    """Raise an error if one of the options, by the name of its parameter, was given."""
    context = click.get_current_context()
    for name, option in options.items():
        if context.get_parameter_source(name) == ParameterSource.COMMANDLINE:
            raise click.UsageError(f"{option} {why}")


def _run_in(file: Path) -> TraceRun:
    # Loaded when needed: the formats of trace files would delay the first picture.
    from rmw_manycore_py.trace.files import load
    from rmw_manycore_py.view.trace_run import TraceRun

    return TraceRun(load(file), file.name)


def _draw(platform: str, output: Path, period_s: float) -> None:
    require_platform(platform)
    with closing(Watch(platform)) as watch:
        look_at(platform, watch)
        time.sleep(period_s)
        _write(look_at(platform, watch), output)


def _write(look: Look, output: Path) -> None:
    chip = Chip.of(look)
    with writing(output):
        output.write_text(chip.svg(chip.marks(look)))
