# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Peers forked by servers: one server per middleware, for this process and its children."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from support import TESTS

# By its path: peers start in any directory.
PEER = Path(__file__).with_name("peer.py")
# The directory with the sockets of the servers.
DIRECTORY_VARIABLE = "MANYCORE_TEST_PEERS"
STATUS_BYTES = 32


class PeerServers:
    """The servers that this process has started; they end with it."""

    def __init__(self) -> None:
        self._directory = tempfile.TemporaryDirectory(prefix="manycore-peers-")
        self._servers: list[subprocess.Popen[bytes]] = []
        os.environ[DIRECTORY_VARIABLE] = self._directory.name

    def serve(self, command: list[str], env: dict[str, str]) -> None:
        """Start the server that forks this peer, unless it runs or the command is not a peer's."""
        if is_peer(command) and not _address(env).exists():
            self.start(env)

    def start(self, env: dict[str, str]) -> None:
        """Start the server for the middleware of an environment."""
        address = _address(env)
        log = address.with_suffix(".log")
        with _socket() as listener, log.open("w") as output:
            listener.bind(str(address))
            listener.listen()
            self._servers.append(
                subprocess.Popen(
                    [sys.executable, "-m", "support.peers.server", str(listener.fileno())],
                    env={**env, "MANYCORE_PLATFORM": Path(self._directory.name).name},
                    cwd=TESTS,
                    stdin=subprocess.PIPE,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    pass_fds=[listener.fileno()],
                )
            )

    def end(self) -> None:
        for server in self._servers:
            server.communicate()  # a server ends at the end of its input
        self._directory.cleanup()


class ForkedPeer:
    """A peer forked by a server, with what Program uses of subprocess.Popen."""

    def __init__(self, command: list[str], env: dict[str, str]) -> None:
        own_output, peer_output = os.pipe()
        peer_input, own_input = os.pipe()
        self.stdin = os.fdopen(own_input, "w")
        self.stdout = os.fdopen(own_output, errors="replace")
        self._log = _address(env).with_suffix(".log")
        self._server = _socket()
        self._server.connect(str(_address(env)))
        request = json.dumps([command[2:], env]).encode()
        socket.send_fds(self._server, [request], [peer_input, peer_output])
        os.close(peer_input)
        os.close(peer_output)
        self.pid = self._receive()
        self._exit_status: int | None = None

    def wait(self, timeout: float | None = None) -> int:
        """Return the exit status; as with Popen, negative for a killed process."""
        if self._exit_status is None:
            if not select.select([self._server], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("peer", timeout or 0)
            self._exit_status = self._receive()
            self._server.close()
        return self._exit_status

    def poll(self) -> int | None:
        try:
            return self.wait(0)
        except subprocess.TimeoutExpired:
            return None

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal; as with Popen, nothing happens if the peer has ended.

        It may have ended before its server reports it.
        """
        if self.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def _receive(self) -> int:
        answer = self._server.recv(STATUS_BYTES)
        assert answer, f"the server of peers has ended: {self._log.read_text()}"
        return int(answer)


def has_server(command: list[str], env: dict[str, str]) -> bool:
    """Return whether a command starts a peer that the server can fork."""
    return is_peer(command) and DIRECTORY_VARIABLE in os.environ and _address(env).exists()


def is_peer(command: list[str]) -> bool:
    return command[:2] == [sys.executable, str(PEER)]


def _address(env: dict[str, str]) -> Path:
    return Path(os.environ[DIRECTORY_VARIABLE]) / f"{env.get('RMW_IMPLEMENTATION', 'none')}.socket"


def _socket() -> socket.socket:
    return socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
