# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Forks peers from a process that has imported rclpy and initialised none of it.

A new interpreter that imports rclpy costs half a second of CPU, a fork some milliseconds; from then
on both behave the same. client.py is the other end: server.py NUMBER-OF-THE-LISTENING-SOCKET.
"""

from __future__ import annotations

import json
import os
import selectors
import signal
import socket
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import NamedTuple

from support.peers import peer
from support.peers.forking import fork, preload

LARGEST_MESSAGE_BYTES = 1 << 17
INTERRUPT = [signal.SIGINT]


class Request(NamedTuple):
    """What a peer runs, and the files that become its standard input and output."""

    arguments: list[str]
    environment: dict[str, str]
    files: list[int]


class PeerServer:
    """Handle one connection per peer: a request arrives, pid and exit status are sent."""

    def __init__(self, listener: socket.socket) -> None:
        self._listener = listener
        self._peers: set[int] = set()
        self._selector = selectors.DefaultSelector()
        self._watch(listener.fileno(), self._accept)
        self._watch(sys.stdin.fileno(), self._end)

    def run(self) -> Request:
        """Serve; return in each peer, with its request."""
        while True:
            for key, _ in self._selector.select():
                if request := key.data():
                    return request

    def _watch(self, file: int, act: Callable[[], Request | None]) -> None:
        self._selector.register(file, selectors.EVENT_READ, act)

    def _accept(self) -> Request | None:
        connection, _ = self._listener.accept()
        data, files, *_ = socket.recv_fds(connection, LARGEST_MESSAGE_BYTES, maxfds=2)
        pid = fork() if data else -1
        if pid == 0:
            return Request(*json.loads(data), files)
        for file in files:
            os.close(file)
        if pid > 0:
            connection.send(str(pid).encode())
            self._peers.add(pid)
            end = os.pidfd_open(pid)
            self._watch(end, partial(self._tell_end, pid, end, connection))
            self._watch(connection.fileno(), partial(self._abandon, pid, connection))
        return None

    def _abandon(self, pid: int, connection: socket.socket) -> None:
        """Kill a peer whose test has crashed: the other end of its connection is closed."""
        if pid in self._peers:
            self._selector.unregister(connection.fileno())
            os.kill(pid, signal.SIGKILL)

    def _tell_end(self, pid: int, end: int, connection: socket.socket) -> None:
        self._selector.unregister(end)
        os.close(end)
        with suppress(KeyError):
            self._selector.unregister(connection.fileno())
        self._peers.remove(pid)
        status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        with connection, suppress(BrokenPipeError):
            connection.send(str(status).encode())

    def _end(self) -> None:
        """End with the process that started the server, together with all peers."""
        for pid in self._peers:
            os.kill(pid, signal.SIGKILL)
        sys.exit()


def become(request: Request) -> None:
    """Make this process equal to a new one started with the request."""
    os.environ.clear()
    os.environ.update(request.environment)
    for own, file in zip(((0,), (1, 2)), request.files, strict=True):
        for number in own:
            os.dup2(file, number)
        os.close(file)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPT)  # what came since the fork comes now


if __name__ == "__main__":
    # Ctrl-C is for the process that started the peers. Not ignored: a peer that is interrupted at
    # once would ignore that, too.
    signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPT)
    preload()
    with socket.socket(fileno=int(sys.argv[1])) as listener:
        request = PeerServer(listener).run()
    become(request)
    peer.call(*request.arguments)
