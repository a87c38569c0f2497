# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The command that starts a mapfile again, or applies what has changed in it."""

from __future__ import annotations


def up_command(mapfile: object, host: str | None, joins: bool = False) -> str:
    """Return the command, in backquotes.

    >>> up_command("robot.yaml", "laptop")
    '`manycore up -d robot.yaml --host laptop`'
    """
    of_host = f" --host {host}" if host else ""
    return f"`manycore up -d {mapfile}{of_host}{' --join' if joins else ''}`"
