# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Services: every client gets the responses to its own requests."""

from __future__ import annotations

from rclpy.qos import QoSProfile, qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from service_msgs.msg import ServiceEventInfo
from std_srvs.srv import SetBool
from test_msgs.message_fixtures import get_msg_arrays
from test_msgs.srv import Arrays, BasicTypes

from support import TIMEOUT_S
from support.nodes.ros import announce, peer_node, spin, spin_until


def double(request: BasicTypes.Request, response: BasicTypes.Response) -> BasicTypes.Response:
    response.int64_value = 2 * request.int64_value
    response.string_value = request.string_value
    return response


def serve() -> None:
    with peer_node("server") as node:
        node.create_service(BasicTypes, "double", double)
        spin(node)


def ask(name: str, count: int) -> None:
    """Send `count` requests at once and check their responses."""
    with peer_node(name) as node:
        client = node.create_client(BasicTypes, "double")
        assert client.wait_for_service(TIMEOUT_S)
        requests = [BasicTypes.Request(int64_value=n, string_value=name) for n in range(count)]
        answers = [client.call_async(request) for request in requests]
        spin_until(node, lambda: all(answer.done() for answer in answers))
        results = [answer.result() for answer in answers]
        assert [result.int64_value for result in results] == [2 * n for n in range(count)]
        assert {result.string_value for result in results} == {name}
        announce("all answers are right")


def test_several_clients(node, start_peer):
    """Six clients with overlapping request numbers, in three clusters, one server."""
    node.create_service(BasicTypes, "double", double, qos_profile=QoSProfile(depth=60))
    clients = [start_peer(ask, f"client_{n}", 10, cluster=1 + n % 3) for n in range(6)]
    ended = lambda: not any(client.is_running() for client in clients)  # noqa: E731
    spin_until(node, ended, 2 * TIMEOUT_S)  # six interpreters start at the same time
    for client in clients:
        client.wait_for("all answers are right")
        assert client.wait() == 0


def test_server_elsewhere(node, start_peer, peer_cluster):
    start_peer(serve, cluster=peer_cluster)
    client = node.create_client(BasicTypes, "double")
    assert client.wait_for_service(TIMEOUT_S)
    answer = client.call_async(BasicTypes.Request(int64_value=21, string_value="x"))
    spin_until(node, answer.done)
    assert (answer.result().int64_value, answer.result().string_value) == (42, "x")


def test_server_and_client_in_one_node(node):
    node.create_service(BasicTypes, "double", double)
    client = node.create_client(BasicTypes, "double")
    assert client.wait_for_service(TIMEOUT_S)
    answer = client.call_async(BasicTypes.Request(int64_value=4))
    spin_until(node, answer.done)
    assert answer.result().int64_value == 8


def test_large_requests_and_answers(node):
    def mirror(request, response):
        response.string_values = request.string_values
        return response

    node.create_service(Arrays, "mirror", mirror)
    client = node.create_client(Arrays, "mirror")
    assert client.wait_for_service(TIMEOUT_S)
    strings = [letter * 1_000_000 for letter in "abc"]
    request = Arrays.Request(string_values=strings)
    request.basic_types_values = get_msg_arrays()[0].basic_types_values
    answer = client.call_async(request)
    spin_until(node, answer.done)
    assert list(answer.result().string_values) == strings


def test_service_goes_away(node, start_peer, peer_cluster):
    peer = start_peer(serve, cluster=peer_cluster)
    client = node.create_client(BasicTypes, "double")
    assert client.wait_for_service(TIMEOUT_S)
    peer.wait_for("^spinning$")
    assert peer.stop_node()
    spin_until(node, lambda: not client.service_is_ready())


def test_a_killed_server_is_not_ready(node, start_peer, peer_cluster):
    peer = start_peer(serve, cluster=peer_cluster)
    client = node.create_client(BasicTypes, "double")
    assert client.wait_for_service(TIMEOUT_S)
    peer.kill()
    spin_until(node, lambda: not client.service_is_ready())


def test_a_new_server_takes_over(node, start_peer, peer_cluster):
    client = node.create_client(BasicTypes, "double")
    for value in (1, 2, 3):
        peer = start_peer(serve, cluster=peer_cluster)
        assert client.wait_for_service(TIMEOUT_S)
        answer = client.call_async(BasicTypes.Request(int64_value=value))
        spin_until(node, answer.done)
        assert answer.result().int64_value == 2 * value
        peer.wait_for("^spinning$")
        assert peer.stop_node()
        spin_until(node, lambda: not client.service_is_ready())


def test_service_introspection(node):
    """Requests and responses are published on the service's event topic."""

    def switch(request, response):
        response.success = request.data
        return response

    events = []
    service = node.create_service(SetBool, "switch", switch)
    client = node.create_client(SetBool, "switch")
    for end in (service, client):
        end.configure_introspection(
            node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS
        )
    node.create_subscription(SetBool.Event, "switch/_service_event", events.append, 10)
    assert client.wait_for_service(TIMEOUT_S)
    spin_until(node, lambda: node.count_publishers("/switch/_service_event") == 2)
    client.call_async(SetBool.Request(data=True))
    spin_until(node, lambda: len(events) == 4)
    assert sorted(event.info.event_type for event in events) == [
        ServiceEventInfo.REQUEST_SENT,
        ServiceEventInfo.REQUEST_RECEIVED,
        ServiceEventInfo.RESPONSE_SENT,
        ServiceEventInfo.RESPONSE_RECEIVED,
    ]
    assert len({event.info.sequence_number for event in events}) == 1
