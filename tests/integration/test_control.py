# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The control socket of a run: no client ends the run, whatever it sends or leaves undone.

Random requests cannot prove that none does harm; they are those of one seed.
"""

from __future__ import annotations

import json
import os
import random
import resource
import socket
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.launch.control import MAX_CLIENTS, STOP_PLACES
from rmw_manycore_py.launch.runs.directory import RunDirectory, runs_of
from rmw_manycore_py.launch.runs.lines import MAX_LINE_BYTES
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.peers.programs import forked_manycore
from support.processes.inspection import is_asleep
from support.processes.program import Program
from support.sources.advice import run_quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

MAPFILE = """
nodes:
  stays: {cluster: 1, command: [sleep, '1000'], ros_arguments: false}
  typed: {cluster: 1, command: [cat], ros_arguments: false, terminal: true}
"""
STATE = b'{"do": "state"}'
DEPTH = 100_000
HUGE = "9" * 5000
RANDOM_REQUESTS = 3000

REFUSED = {
    "deep": b"[" * DEPTH,
    "deep in a request": b'{"do": ' + b"[" * DEPTH,
    "deep in objects": b'{"do":' * DEPTH,
    "long": b" " * (MAX_LINE_BYTES + 1),
    "empty": b"",
    "no object": b"[]",
    "no text": b"\xff\xfe",
    "zeros": b"\0" * 1000,
    "no request": b'{"do": null}',
    "unknown request": b'{"do": "fly"}',
    "request without do": b'{"nodes": ["stays"]}',
    "unknown key": b'{"do": "stop", "node": ["stays"]}',
    "no node": b'{"do": "stop", "nodes": []}',
    "unknown node": b'{"do": "stop", "nodes": ["stays", "\\u0000"]}',
    "half a character": b'{"do": "stop", "nodes": ["\\ud800"]}',
    "no names": b'{"do": "restart", "nodes": 5}',
    "names missing": b'{"do": "restart"}',
    "no cluster": b'{"do": "move", "node": "stays"}',
    "no number": b'{"do": "move", "node": "stays", "cluster": "2"}',
    "no check": b'{"do": "apply", "check": 1}',
    "no flag": b'{"do": "restart", "nodes": ["stays"], "terminal": "no"}',
    "no terminal": b'{"do": "attach", "node": "stays"}',
    "no size": b'{"do": "attach", "node": "typed", "size": "large"}',
    "huge size": b'{"do": "attach", "node": "typed", "size": [1e999, 1]}',
    "huge integer": f'{{"do": "attach", "node": "typed", "size": [{HUGE}, 1]}}'.encode(),
    "not a number": b'{"do": "attach", "node": "typed", "size": [NaN, 1]}',
}
REFUSED_WHILE_ATTACHED = {
    "no Base64": b'{"input": "~"}',
    "no text": b'{"input": 5}',
    "huge size": b'{"size": [1e999, 1]}',
    "short size": b'{"size": [1]}',
    "request": b'{"do": "state"}',
    "deep": b"[" * DEPTH,
}


@pytest.fixture
def run(start, tmp_path: Path, platform: str) -> Iterator[Program]:
    """Yield a run of two nodes, which must still be its nodes at the end of the test."""
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(MAPFILE)
    started = start(forked_manycore("run", mapfile))
    for node in ("stays", "typed"):
        started.wait_for(f"{node} started")
    before = pids(platform)
    yield started
    if started.is_running():
        assert pids(platform) == before
        assert started.stop() == 0


class Client:
    """Client that sends what it likes."""

    def __init__(self, platform: str) -> None:
        (run,) = runs_of(platform)
        self.socket = _connected(run)

    def say(self, line: bytes) -> None:
        with suppress(BrokenPipeError, ConnectionResetError):  # it was refused midway
            self.socket.sendall(line + b"\n")

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def answers(self) -> list[dict[str, Any]]:
        """Return all answers until the supervisor closes the connection."""
        data = b""
        with suppress(ConnectionResetError):  # it closed with input unread
            while more := self.socket.recv(1 << 16):
                data += more
        return [json.loads(line) for line in data.splitlines()]

    def answer(self) -> dict[str, Any]:
        """Return the next answer, byte by byte: others may follow."""
        line = b""
        while not line.endswith(b"\n"):
            byte = self.socket.recv(1)
            assert byte, "the supervisor has closed the connection"
            line += byte
        return dict(json.loads(line))


def _connected(run: RunDirectory) -> socket.socket:
    found = []

    def connects() -> bool:
        with suppress(BlockingIOError):  # many wait to be accepted
            found.append(run.connect(TIMEOUT_S))
        return bool(found)

    wait_until(connects, "the supervisor accepts")
    return found[0]


def asked(platform: str, line: bytes) -> list[dict[str, Any]]:
    with Client(platform) as client:
        client.say(line)
        return client.answers()


def pids(platform: str) -> dict[str, int]:
    (answer,) = asked(platform, STATE)
    return {node["name"]: node["pid"] for node in answer["nodes"]}


def supervisor(platform: str) -> int:
    (run,) = runs_of(platform)
    return int(run.info["pid"])


def test_what_is_no_request_is_refused(run, platform) -> None:
    for name, line in REFUSED.items():
        answers = asked(platform, line)
        assert [list(answer) for answer in answers] == [["error"]], name
    for name, line in REFUSED_WHILE_ATTACHED.items():
        with Client(platform) as client:
            client.say(b'{"do": "attach", "node": "typed", "size": [24, 80]}')
            assert "output" in client.answer()
            client.say(line)
            assert "error" in client.answers()[-1], name


def test_an_unknown_key_is_named(run, platform) -> None:
    (answer,) = asked(platform, b'{"do": "stop", "nodez": ["stays"]}')
    assert answer["error"].startswith("invalid request: stop.nodez: ")


def test_a_client_is_not_heard_after_its_error(run, platform) -> None:
    assert len(asked(platform, b'{"do": "fly"}\n{"do": "stop"}')) == 1
    assert len(asked(platform, b'{"do": "state"}\n{"do": "stop"}')) == 1


def random_value(chance: random.Random, depth: int = 0) -> Any:
    names = ["stays", "typed", "\0", "\ud800", "x" * 300, "stop", ""]
    plain = [None, True, -1, 1 << 70, 1e308, float("inf"), float("nan"), chance.choice(names)]
    if depth < 3 and chance.random() < 0.4:
        values = [random_value(chance, depth + 1) for _ in range(chance.randrange(4))]
        return values if chance.random() < 0.5 else {str(value)[:50]: value for value in values}
    return chance.choice(plain)


def random_request(chance: random.Random) -> bytes:
    keys = ["nodes", "node", "size", "terminal", "input", "more", ""]
    message = {key: random_value(chance) for key in chance.sample(keys, chance.randrange(4))}
    known = ["state", "stop", "restart", "follow", "attach"]
    do = chance.choice([*known, *known, random_value(chance)])
    if do == "stop" and message.get("nodes") is None:
        message["nodes"] = ["stays"]  # without nodes, it is a request to end the run
    line = bytearray(json.dumps({"do": do, **message}).encode())
    if do != "stop" and chance.random() < 0.3:
        line[chance.randrange(len(line))] = chance.randrange(256)
    return bytes(line)


def test_random_requests_do_not_end_a_run(start, tmp_path, platform) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(MAPFILE)
    run = start(forked_manycore("run", mapfile))
    run.wait_for("typed started")
    chance = random.Random(38)
    for _ in range(RANDOM_REQUESTS // 10):
        with Client(platform) as client:
            for _ in range(10):
                client.say(random_request(chance))
            if chance.random() < 0.5:
                client.socket.shutdown(socket.SHUT_WR)
                client.answers()
    assert set(pids(platform)) == {"stays", "typed"}
    run.skip_output()
    with Client(platform) as client:
        client.say(b'{"do": "restart", "nodes": ["stays"]}')
        run.wait_for("stays started")
    assert run.stop() == 0
    assert "supervisor failed" not in run.output


def test_slow_and_half_closed_clients_are_answered(run, platform) -> None:
    request = b'{"do": "state"}\n'
    with Client(platform) as slow, Client(platform) as silent:
        for byte in request:
            slow.socket.sendall(bytes([byte]))
            assert set(pids(platform)) == {"stays", "typed"}
        assert "nodes" in slow.answer()
        silent.socket.shutdown(socket.SHUT_WR)
        assert silent.answers() == []
    with Client(platform) as half:
        half.say(b'{"do": "state"}')
        half.socket.shutdown(socket.SHUT_WR)
        assert "nodes" in half.answers()[0]


def test_thousands_of_clients(run, platform) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    try:
        with ExitStack() as stack:
            clients = [stack.enter_context(Client(platform)) for _ in range(2000)]
            for client in clients[MAX_CLIENTS:]:
                client.say(STATE)
                (answer,) = client.answers()
                assert f"{MAX_CLIENTS} clients are connected" in answer["error"]
            clients[0].say(STATE)
            assert "nodes" in clients[0].answer()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    wait_until(lambda: "nodes" in asked(platform, STATE)[0], "there is room again")


def test_a_run_without_room_for_a_client_is_stopped_all_the_same(start, run, platform) -> None:
    with ExitStack() as stack:
        for _ in range(MAX_CLIENTS + STOP_PLACES):
            stack.enter_context(Client(platform))
        refused = start(forked_manycore("restart", "--platform", platform, "stays"))
        assert refused.wait() == 1
        assert "`manycore stop` is still served" in refused.output
        stop = start(forked_manycore("stop", "--platform", platform))
        assert stop.wait() == 0, stop
        assert run.wait() == 0, run


def test_a_supervisor_without_descriptors_turns_clients_away_and_can_be_killed(run, platform):
    pid = supervisor(platform)
    limits = resource.prlimit(pid, resource.RLIMIT_NOFILE)
    used = len(os.listdir(f"/proc/{pid}/fd"))
    resource.prlimit(pid, resource.RLIMIT_NOFILE, (used, limits[1]))
    for _ in range(3):
        (answer,) = asked(platform, STATE)
        assert "out of file descriptors" in answer["error"]
    wait_until(lambda: is_asleep(pid), "no client is left that would keep it awake")
    run_quoted(answer["error"], "kill")
    assert run.wait() == 0, run
