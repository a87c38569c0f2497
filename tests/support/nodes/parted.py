# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One mapfile over hosts, `a` with a talker, the others with a listener; nodes beside them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rmw_manycore_bridge.status import status
from rmw_manycore_py.native._transport import Platform
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command, peer_command
from support.processes.platforms import unique_platform
from support.processes.program import Program

HOSTS = ("a", "b")
HEARD = r"^listener\d? .*I heard: 'Hello World"


def _mapfile(addresses: Mapping[str, str]) -> str:
    """Return a mapfile with one cluster for each host."""
    hosts, nodes = ["hosts:"], ["nodes:"]
    for cluster, (host, address) in enumerate(addresses.items(), 1):
        hosts.append(f"  {host}: {{clusters: [{cluster}], address: {address}}}")
        name = "talker" if cluster == 1 else f"listener{cluster if cluster > 2 else ''}"
        module = f"rmw_manycore_py.examples.{name.rstrip('0123456789')}"
        nodes.append(f"  {name}: {{cluster: {cluster}, module: {module}}}")
    shape = f"platform: {{clusters: {len(addresses)}, cores_per_cluster: 8}}"
    return "\n".join((shape, *hosts, *nodes, ""))


class Parted:
    """Hosts, each with a platform; `prefixes` are words that run a command on one."""

    def __init__(
        self,
        start: Callable[..., Program],
        directory: Path,
        addresses: Mapping[str, str],
        prefixes: Mapping[str, list[str]] | None = None,
    ) -> None:
        self._start, self._prefixes, self.addresses = start, prefixes or {}, addresses
        self.platforms = {host: unique_platform() for host in addresses}
        self.mapfile = directory / "hosts.yaml"
        self.mapfile.write_text(_mapfile(addresses))

    def run(self, host: str, **env: str) -> Program:
        """Start the part of a host."""
        prefix = self._prefixes.get(host, [])
        command = manycore_command if prefix or env else forked_manycore
        words = map(str, command("run", self.mapfile, "--host", host))
        return self._start([*prefix, *words], MANYCORE_PLATFORM=self.platforms[host], **env)

    def run_all(self, **env: str) -> dict[str, Program]:
        """Start all parts, and return once the listeners hear the talker."""
        runs = {host: self.run(host, **env) for host in self.platforms}
        for host in [*self.platforms][1:]:
            runs[host].wait_for(HEARD)
        return runs

    def node(self, host: str, function: Callable[..., None], *arguments: Any) -> Program:
        """Start a node on a host."""
        command = peer_command(function, *arguments)
        return self._start(command, MANYCORE_PLATFORM=self.platforms[host])

    def tool(self, host: str, *words: str) -> Program:
        """Start `manycore` on a host."""
        return self._start(forked_manycore(*words), MANYCORE_PLATFORM=self.platforms[host])

    def command(self, host: str, *words: str) -> str:
        """Return what `manycore` prints on a host."""
        program = self.tool(host, *words)
        assert program.wait() == 0, program
        return program.output

    def gids(self, host: str, topic: str) -> dict[str, bytes]:
        """Return the gids of publishers of a topic by their nodes, as a host shows them."""
        with Platform(self.platforms[host]) as seen:
            rows = [row for row in seen.endpoints() if row.topic == topic]
        return {row.node_name: row.gid for row in rows if row.kind == "publisher"}

    def row(
        self, host: str, direction: str, name: str, kind: str = "topic", peer: str | None = None
    ) -> dict[str, Any]:
        """Return the counters of what crosses, to one peer if there are several."""
        wanted = {"direction": direction, "inside": name, "kind": kind}
        if peer is not None:
            wanted["peer"] = peer
        rows = status(self.platforms[host])
        return next((r for r in rows if wanted.items() <= r.items()), {})
