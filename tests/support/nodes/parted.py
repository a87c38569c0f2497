# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One mapfile over two hosts, `a` with a talker and `b` with a listener; nodes beside them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rmw_manycore_bridge.status import status
from support.processes.commands import manycore_command, peer_command
from support.processes.platforms import unique_platform
from support.processes.program import Program

HOSTS = ("a", "b")
HEARD = r"^listener .*I heard: 'Hello World"
MAPFILE = """
platform: {{clusters: 2, cores_per_cluster: 8}}
hosts:
  a: {{clusters: [1], address: {a}}}
  b: {{clusters: [2], address: {b}}}
nodes:
  talker: {{cluster: 1, module: rmw_manycore_py.examples.talker}}
  listener: {{cluster: 2, module: rmw_manycore_py.examples.listener}}
"""


class Parted:
    """Two hosts, each with a platform; `prefixes` are words that run a command on one."""

    def __init__(
        self,
        start: Callable[..., Program],
        directory: Path,
        addresses: Mapping[str, str],
        prefixes: Mapping[str, list[str]] | None = None,
    ) -> None:
        self._start, self._prefixes = start, prefixes or {}
        self.platforms = {host: unique_platform() for host in HOSTS}
        self.mapfile = directory / "hosts.yaml"
        self.mapfile.write_text(MAPFILE.format(**addresses))

    def run(self, host: str, **env: str) -> Program:
        """Start the part of a host."""
        command = map(str, manycore_command("run", self.mapfile, "--host", host))
        words = [*self._prefixes.get(host, ()), *command]
        return self._start(words, MANYCORE_PLATFORM=self.platforms[host], **env)

    def run_both(self, **env: str) -> dict[str, Program]:
        """Start both parts, and return once the listener hears the talker."""
        runs = {host: self.run(host, **env) for host in HOSTS}
        runs["b"].wait_for(HEARD)
        return runs

    def node(self, host: str, function: Callable[..., None], *arguments: Any) -> Program:
        """Start a node on a host."""
        command = peer_command(function, *arguments)
        return self._start(command, MANYCORE_PLATFORM=self.platforms[host])

    def row(self, host: str, direction: str, name: str, kind: str = "topic") -> dict[str, Any]:
        """Return the counters of what crosses."""
        key = (direction, name, kind)
        rows = status(self.platforms[host])
        return next((r for r in rows if (r["direction"], r["inside"], r["kind"]) == key), {})
