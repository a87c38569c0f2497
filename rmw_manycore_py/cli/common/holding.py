# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Virtual time of a run that stands, and goes on, at the request of a client."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.runs import living_runs
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.event_text import text_of
from rmw_manycore_py.launch.events import Finished, Held, event_of
from rmw_manycore_py.launch.runs.client import Client


def ask_for_time(platform: str, do: str, *, waits: bool, **arguments: Any) -> None:
    """Send a request to the latest run of a platform; print when and why time stands then.

    :param waits: until it does.
    :raises ManycoreError: if the run ends before.
    """
    with Client(living_runs(platform)[-1], do, **arguments) as client:
        if not waits:
            return
        for message in client.messages():
            event = event_of(message)
            if isinstance(event, Held):
                echo(text_of(event) or "")
                return
            if isinstance(event, Finished):
                break
    raise ManycoreError("the run has ended")
