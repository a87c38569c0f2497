# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where the page is served: a listening socket on 127.0.0.1, and the token of its link."""

from __future__ import annotations

import errno
import secrets
import socket
from dataclasses import dataclass

from rmw_manycore_py.errors import ManycoreError

ADDRESS = "127.0.0.1"
_TOKEN_BYTES = 18


@dataclass(frozen=True)
class Listener:
    """A browser may connect from now on; it is answered once the server runs."""

    socket: socket.socket
    token: str

    @property
    def port(self) -> int:
        """Port on 127.0.0.1."""
        return int(self.socket.getsockname()[1])

    @property
    def link(self) -> str:
        """URL to open."""
        return f"http://{ADDRESS}:{self.port}/{self.token}/"


def listen(port: int) -> Listener:
    """Listen with a new token; port 0 picks a free port.

    :raises ManycoreError: if the port cannot be used.
    """
    try:
        return Listener(socket.create_server((ADDRESS, port)), secrets.token_urlsafe(_TOKEN_BYTES))
    except OSError as error:
        if error.errno not in (errno.EADDRINUSE, errno.EACCES):
            raise ManycoreError(f"cannot listen on {ADDRESS}:{port}: {error.strerror}") from error
        what = "in use, possibly by another manycore view"
        if error.errno == errno.EACCES:
            what = "not for this user"
        raise ManycoreError(
            f"port {port} is {what}; choose another: --port N, 0 for any"
        ) from error
