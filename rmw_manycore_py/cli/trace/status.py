# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace status`."""

from __future__ import annotations

import time

import click

from rmw_manycore_py.cli.common.options import examples, json_option, platform_option
from rmw_manycore_py.cli.common.printing import counted, echo, print_json
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors


@click.command("status", epilog=examples("manycore trace status"))
@platform_option
@json_option
def command(platform: str, as_json: bool) -> None:
    """Show whether a platform is traced.

    And how many events wait to be saved.
    """
    require_platform(platform)
    with translate_native_errors():
        state = _transport.trace_state(platform)
    is_on = state.started_ns != 0
    since_s = (time.monotonic_ns() - state.started_ns) / 1e9 if is_on else None
    if as_json:
        print_json(
            {
                "platform": platform,
                "on": is_on,
                "since_s": since_s,
                "clusters": state.clusters,
                "nodes": state.nodes,
                "events": state.pending,
                "lost": state.lost,
            }
        )
        return
    what = [f"cluster {cluster}" for cluster in state.clusters] + state.nodes
    if since_s is None:
        echo(f"platform {platform} is not traced")
    else:
        echo(f"platform {platform} has been traced for {since_s:.1f} s: {', '.join(what)}")
    echo(f"{counted(state.pending, 'event')} to be saved, {state.lost} lost")
