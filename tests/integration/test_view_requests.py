# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests that no browser sends: `manycore view` answers or ends the connection, and goes on."""

from __future__ import annotations

import json
import os
import re
import resource
import socket
import urllib.request
from base64 import b64encode
from contextlib import ExitStack, suppress

import pytest

from support import IS_MANYCORE, TIMEOUT_S, wait_until

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

# {host}: the address of the page; {token}: the token of its link.
REQUESTS = [
    "OPTIONS * HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n\r\n",
    "OPTIONS * HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET * HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /\xff\xfe HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /%ff%00 HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET //// HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET http://{host} HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "CONNECT {host} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n\r\n",
    "CONNECT {host}:x HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET / HTTP/1.1\r\n\r\n",
    "GET / HTTP/1.1\r\nHost: {host}\r\nHost: {host}\r\n\r\n",
    "GET / HTTP/9.9\r\nHost: {host}\r\n\r\n",
    "GET /{token}/trace/%2e%2e%2f%00 HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /{token}/page/%00 HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /{token}/page/" + "a" * 300 + " HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /{token}/trace/" + "a" * 300 + " HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /{token}/live HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET /" + "a" * 100_000 + " HTTP/1.1\r\nHost: {host}\r\n\r\n",
    "GET / HTTP/1.1\r\nHost: {host}\r\nX: " + "a" * 100_000 + "\r\n\r\n",
    "POST /{token}/parameters?node=%ff%00 HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n\r\n",
    "POST / HTTP/1.1\r\nHost: {host}\r\nContent-Length: -1\r\n\r\n",
    "POST / HTTP/1.1\r\nHost: {host}\r\nTransfer-Encoding: chunked\r\n\r\nZZ\r\n",
    "\0\0\0\0\r\n\r\n",
    "\r\n" * 1000,
    "\x16\x03\x01\x02\x00\x01\x00",  # the first bytes of TLS
]
SELECTIONS = [
    "[" * 4000,
    '{"select":' * 400,
    '{"select": {"node": "\\ud800"}}',
    '{"select": {"node": "\\u0000"}}',
    '{"select": {"topic": 1e999}}',
    '{"select": {"topic": ["/chatter"]}}',
    "null",
    "9" * 4000,
]


def connected(link: str) -> socket.socket:
    return socket.create_connection(address(link), TIMEOUT_S)


def address(link: str) -> tuple[str, int]:
    host, port = link.split("/")[2].split(":")
    return host, int(port)


def answer(link: str, request: str) -> bytes:
    """Return all answers to a request, sent alone in its connection."""
    host, token = link.split("/")[2:4]
    is_whole = "Host: " in request
    if is_whole:
        request = request.replace("\r\nHost", "\r\nConnection: close\r\nHost", 1)
    filled = request.replace("{host}", host).replace("{token}", token)
    data = b""
    with connected(link) as client, suppress(ConnectionError):
        client.sendall(filled.encode("latin-1"))
        if not is_whole:  # the server would wait for the rest
            client.shutdown(socket.SHUT_WR)
        while more := client.recv(1 << 16):
            data += more
    return data


def is_served(link: str) -> bool:
    with suppress(OSError), urllib.request.urlopen(link, timeout=TIMEOUT_S) as page:
        return bool(page.status == 200)
    return False


def test_a_request_of_no_browser_is_no_error_of_the_server(view) -> None:
    program, link = view
    for request in REQUESTS:
        data = answer(link, request)
        assert not re.match(rb"HTTP/\S+ 5", data), request[:100]
        assert re.match(rb"HTTP/\S+ [234]|$", data), request[:100]
    assert is_served(link)
    assert "Traceback" not in program.output


def live(link: str) -> socket.socket:
    """Return a WebSocket of the page."""
    host, token = link.split("/")[2:4]
    client = connected(link)
    key = b64encode(os.urandom(16)).decode()
    client.sendall(
        f"GET /{token}/live HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n"
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        f"Sec-WebSocket-Key: {key}\r\n\r\n".encode()
    )
    head = b""
    while not head.endswith(b"\r\n\r\n"):
        head += client.recv(1)
    assert head.startswith(b"HTTP/1.1 101 ")
    return client


def frame(kind: int, data: bytes) -> bytes:
    """Return a frame as a browser sends it, masked with zeros."""
    assert len(data) < 1 << 16
    return bytes([0x80 | kind, 0x80 | 126]) + len(data).to_bytes(2, "big") + bytes(4) + data


def received(client: socket.socket) -> tuple[int, bytes]:
    """Return kind and data of the next frame."""

    def exactly(count: int) -> bytes:
        data = b""
        while len(data) < count:
            data += (more := client.recv(count - len(data)))
            assert more, "the server has closed the connection"
        return data

    first, length = exactly(2)
    size = {126: 2, 127: 8}.get(length)
    return first & 0xF, exactly(int.from_bytes(exactly(size), "big") if size else length)


def test_a_selection_that_is_none_leaves_the_page_alone(view) -> None:
    program, link = view
    for selection in SELECTIONS:
        with live(link) as client:
            client.sendall(frame(1, selection.encode()))
            for _ in range(3):
                kind, data = received(client)
                assert kind == 1, selection[:40]
                assert "state" in json.loads(data)
    for kind, data in ((1, b"\xff"), (2, b"\0" * 5000), (7, b""), (8, b"\0")):
        with live(link) as client:
            client.sendall(frame(kind, data))
            with suppress(AssertionError, ConnectionError):  # it is closed, or reports a violation
                while received(client)[0] != 8:
                    pass
    assert is_served(link)
    assert "Traceback" not in program.output


def test_connections_that_leave_no_descriptor(view) -> None:
    program, link = view
    soft, hard = resource.prlimit(program.pid, resource.RLIMIT_NOFILE)
    used = len(os.listdir(f"/proc/{program.pid}/fd"))
    resource.prlimit(program.pid, resource.RLIMIT_NOFILE, (used + 10, hard))
    with ExitStack() as stack:
        for _ in range(100):
            stack.enter_context(connected(link))
    wait_until(lambda: is_served(link), "it is served again")
    resource.prlimit(program.pid, resource.RLIMIT_NOFILE, (soft, hard))
    assert is_served(link)
