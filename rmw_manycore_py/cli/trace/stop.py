# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace stop`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.view import require_platform
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors


@click.command("stop", epilog=examples("manycore trace stop"))
@platform_option
def command(platform: str) -> None:
    """Stop tracing.

    Recorded events can be saved until the platform ends.
    """
    require_platform(platform)
    with translate_native_errors():
        _transport.stop_trace(platform)
