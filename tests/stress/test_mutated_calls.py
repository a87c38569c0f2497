# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many mutated requests and responses: each is taken or counted as lost, and calls go on."""

from __future__ import annotations

import os
import random
import sys
import threading
from functools import partial
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import Parameter, ParameterDescriptor, SetParametersResult
from rcl_interfaces.srv import DescribeParameters, ListParameters, SetParameters
from rclpy.serialization import serialize_message
from std_srvs.srv import SetBool
from test_msgs.srv import Arrays, BasicTypes, Empty

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.ros import announce, peer_node, spin_until
from support.processes.commands import peer_command

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="sends with the transport's own binding")

CALLS = int(os.environ.get("MANYCORE_TEST_MUTATED_CALLS", "10000"))
BATCH = 8  # fewer than the depth of a service
WORDS = (0, 1, 2, 0xFF, 0x7FFFFFFF, 0xFFFFFFFF)

# By the name of a service: its type, and valid data of a request and of a response.
SERVICES: dict[str, tuple[Any, Any, Any]] = {
    "arrays": (Arrays, Arrays.Request(), Arrays.Response()),
    "basic_types": (
        BasicTypes,
        BasicTypes.Request(string_value="text"),
        BasicTypes.Response(string_value="text"),
    ),
    "empty": (Empty, Empty.Request(), Empty.Response()),
    "list_parameters": (
        ListParameters,
        ListParameters.Request(prefixes=["a", "bc"]),
        ListParameters.Response(),
    ),
    "describe_parameters": (
        DescribeParameters,
        DescribeParameters.Request(names=["a", "bc"]),
        DescribeParameters.Response(descriptors=[ParameterDescriptor(name="a")]),
    ),
    "set_bool": (SetBool, SetBool.Request(data=True), SetBool.Response(message="text")),
    "set_parameters": (
        SetParameters,
        SetParameters.Request(parameters=[Parameter(name="a"), Parameter(name="bc")]),
        SetParameters.Response(results=[SetParametersResult(reason="text")]),
    ),
}


def mutated(cdr: bytes) -> bytes:
    """Change bytes or words, preferably lengths, or the size."""
    data = bytearray(cdr)
    for _ in range(random.choice((1, 1, 2, 4))):
        at = random.randrange(len(data))
        what = random.randrange(5)
        if what == 0:
            data[at] = random.randrange(256)
        elif what == 1:
            at -= at % 4
            data[at : at + 4] = random.choice(WORDS).to_bytes(4, "little")
        elif what == 2:
            del data[max(at, 1) :]
        elif what == 3:
            data += random.randbytes(random.randrange(1, 9))
        else:
            data[at : at + 4] = random.randbytes(4)
    return bytes(data)


def serve() -> None:
    """Serve and call each service; print on request how many requests of it were served."""
    with peer_node("server") as node:
        served = dict.fromkeys(SERVICES, 0)

        def answer(name: str, _: Any, response: Any) -> Any:
            served[name] += 1
            return response

        clients = {}
        for name, (service_type, _, _) in SERVICES.items():
            node.create_service(service_type, name, partial(answer, name))
            clients[name] = node.create_client(service_type, name)
        for client in clients.values():
            assert client.wait_for_service(TIMEOUT_S)
        asked: list[str] = []
        threading.Thread(target=lambda: asked.extend(sys.stdin), daemon=True).start()
        announce("serves")
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.01)
            while asked:
                verb, name = asked.pop(0).split()
                if verb == "call":
                    future = clients[name].call_async(SERVICES[name][1])
                    spin_until(node, future.done)
                announce(f"served {served[name]}")


class Target:
    """The server and the client of one service, to which this process sends bytes."""

    def __init__(self, process: Any, platform: str, peer: Any, name: str) -> None:
        self._platform, self._peer, self._name = platform, peer, name
        ends = {e.role: e for e in process.endpoints_of(f"/{name}") if e.kind == "subscription"}
        self._senders = {
            role: (process.publisher(f"/{name}", end.type, end.qos, role=role), end.gid)
            for role, end in ends.items()
        }
        self._valid = {
            role: serialize_message(data)
            for role, data in zip(("request", "reply"), SERVICES[name][1:], strict=True)
        }
        self._sent = 0

    def mutate(self, count: int) -> None:
        """Send `count` mutated requests and responses, and wait until each is counted."""
        for role, (sender, gid) in self._senders.items():
            for number in range(count):
                sender.publish(mutated(self._valid[role]), client=gid, number=number + 1)
        self._sent += count
        wait_until(
            lambda: self._served() + self.lost() == self._sent, f"{self._name} has taken all"
        )

    def call(self) -> None:
        """Check that a valid request is answered."""
        self._sent += 1
        self._peer.say(f"call {self._name}")
        self._peer.wait_for(r"served \d+")

    def lost(self) -> int:
        """Return how many requests the service has dropped."""
        from rmw_manycore_py.native import _transport

        with _transport.Platform(self._platform) as platform:
            return sum(
                end.counters.lost
                for end in platform.endpoints()
                if (end.topic, end.role) == (f"/{self._name}", "request")
            )

    def _served(self) -> int:
        self._peer.say(f"tell {self._name}")
        return int(self._peer.wait_for(r"served (\d+)").group(1))


def test_mutated_calls_are_taken_or_counted(seed, start, platform: str) -> None:
    from rmw_manycore_py.native import _transport

    peer = start(peer_command(serve))
    peer.wait_for("serves")
    with _transport.Process(platform, 1, None, "mutator") as process:
        targets = [Target(process, platform, peer, name) for name in SERVICES]
        for _ in range(CALLS // BATCH // len(targets)):
            for target in targets:
                target.mutate(BATCH)
        for target in targets:
            assert target.lost() > 0
            target.call()
    assert peer.is_running(), peer
