# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Peers of rmw_zenoh for the bridge's tests: a router, and nodes of zenoh-ros2-sdk.

The SDK was not written here. It computes keys, tokens, attachments and type hashes itself.
"""

from __future__ import annotations

import json
import os
import socket
import struct
import tempfile
import threading
import time
from typing import Any

from support.nodes.ros import announce, type_of
from support.nodes.serving import SET_BOOL

DEFINITIONS = {
    "std_msgs/msg/String": "string data",
    "std_msgs/msg/Int64": "int64 data",
    SET_BOOL: ("bool data", "bool success\nstring message"),
}
BEST_EFFORT = "2"


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def locator(port: int) -> str:
    return f"tcp/127.0.0.1:{port}"


def session(mode: str, **settings: Any) -> Any:
    """Return a session without multicast."""
    import zenoh

    config = zenoh.Config()
    config.insert_json5("mode", json.dumps(mode))
    config.insert_json5("scouting/multicast/enabled", "false")
    for key, value in settings.items():
        config.insert_json5(key.replace("__", "/"), json.dumps(value))
    return zenoh.open(config)


def peer_session(port: int) -> Any:
    return session(
        "peer", connect__endpoints=[locator(port)], listen__endpoints=["tcp/127.0.0.1:0"]
    )


def route(port: int) -> None:
    """Be the router."""
    router = session("router", listen__endpoints=[locator(port)])
    announce("routing")
    stay()
    router.close()


def stay() -> None:
    """Keep this process until it is ended."""
    threading.Event().wait()


def sdk_of(port: int, domain: int) -> tuple[Any, dict[str, Any]]:
    """Return the SDK, and where its ends connect to."""
    os.environ["HOME"] = tempfile.mkdtemp()  # no cache of definitions
    import zenoh_ros2_sdk

    return zenoh_ros2_sdk, {"router_ip": "127.0.0.1", "router_port": port, "domain_id": domain}


def sdk_say(
    port: int,
    domain: int,
    topic: str,
    count: int | None,
    period_s: float,
    qos: str | None = None,
    type_name: str = "std_msgs/msg/String",
) -> None:
    """Publish numbers, as texts or as they are; without a count, forever."""
    sdk, to = sdk_of(port, domain)
    publisher = sdk.ROS2Publisher(
        topic, type_name, msg_definition=DEFINITIONS[type_name], node_name="speaker", qos=qos, **to
    )
    announce(f"hash {publisher.type_hash}")
    while not publisher.pub.matching_status.matching:
        time.sleep(0.01)
    number = 0
    while count is None or number < count:
        publisher.publish(data=number if type_name.endswith("Int64") else f"number {number}")
        number += 1
        time.sleep(period_s)
    announce("said")
    stay()


def sdk_hear(
    port: int, domain: int, topic: str, qos: str | None = None, until: int | None = None
) -> None:
    """Print texts; with a number, only how many came once its text has come."""
    sdk, to = sdk_of(port, domain)
    texts: list[str] = []

    def heard(message: Any) -> None:
        texts.append(message.data)
        if until is None:
            announce(f"heard {message.data}")
        elif message.data == f"number {until}":
            announce(f"counted {len(texts)} {len(set(texts))}")

    definition = DEFINITIONS["std_msgs/msg/String"]
    kept = sdk.ROS2Subscriber(
        *(topic, "std_msgs/msg/String", heard),
        msg_definition=definition,
        node_name="hearer",
        qos=qos,
        **to,
    )
    announce("listening")
    stay()
    kept.close()


def sdk_serve(port: int, domain: int, answers: bool) -> None:
    """Serve SetBool, or never answer."""
    sdk, to = sdk_of(port, domain)
    request, response = DEFINITIONS[SET_BOOL]

    def answer(asked: Any) -> Any:
        announce("asked")
        if not answers:
            stay()
        return server.response_msg_class(success=asked.data, message="served")

    server = sdk.ROS2ServiceServer(
        *("/lamp", SET_BOOL, answer),
        request_definition=request,
        response_definition=response,
        node_name="server",
        **to,
    )
    announce("serving")
    stay()


def sdk_call(port: int, domain: int, times: int) -> None:
    """Call SetBool, one call after the other, once there is a server."""
    sdk, to = sdk_of(port, domain)
    request, response = DEFINITIONS[SET_BOOL]
    client = sdk.ROS2ServiceClient(
        *("/lamp", SET_BOOL),
        request_definition=request,
        response_definition=response,
        node_name="caller",
        **to,
    )
    while not client.querier.matching_status.matching:
        time.sleep(0.01)
    for number in range(times):
        answer = client.call(data=number % 2 == 0)
        announce(f"answer {answer.success} {answer.message}")
    stay()


def ask(
    port: int, domain: int, service: str, type_name: str, type_hash: str, fields: dict[str, Any]
) -> None:
    """Call a service once it answers, with keys that the SDK makes; print the response."""
    from rclpy.serialization import deserialize_message, serialize_message

    sdk, _ = sdk_of(port, domain)
    kind = type_of(type_name)
    name = sdk.utils.ros2_to_dds_type(type_name)
    key = sdk.keyexpr.topic_keyexpr(domain, service, name, type_hash)
    peer = peer_session(port)
    request = serialize_message(kind.Request(**fields))
    while True:
        for reply in peer.get(key, payload=request, attachment=_attachment("new", 1)):
            if reply.ok is not None:
                answer = deserialize_message(reply.ok.payload.to_bytes(), kind.Response)
                announce(f"answer {answer}")
                stay()


def sdk_list(port: int, domain: int) -> None:
    """Print topics and services whenever they change."""
    sdk, to = sdk_of(port, domain)
    shown = None
    while True:
        topics = sdk.get_topic_names_and_types(**to)
        services = sdk.get_service_names_and_types(**to)
        if (topics, services) != shown:
            shown = (topics, services)
            announce(f"topics {topics} services {services}")


def put(port: int, key: str, attached: str, period_s: float) -> None:
    """Publish texts without tokens: attachment "none", "new", or "old" (with labels)."""
    peer = peer_session(port)
    number = 0
    while True:
        number += 1
        text = f"number {number}".encode() + b"\0"
        data = b"\0\1\0\0" + struct.pack("<I", len(text)) + text
        kwargs = {} if attached == "none" else {"attachment": _attachment(attached, number)}
        peer.put(key, data, **kwargs)
        time.sleep(period_s)


def _attachment(kind: str, number: int) -> bytes:
    stamp, gid = time.time_ns(), bytes(range(16))
    if kind == "new":
        return struct.pack("<qqB", number, stamp, 16) + gid
    labels = [struct.pack("B", len(name)) + name for name in LABELS]
    values = [struct.pack("<q", number), struct.pack("<q", stamp), b"\x10" + gid]
    return b"".join(label + value for label, value in zip(labels, values, strict=True))


LABELS = (b"sequence_number", b"source_timestamp", b"source_gid")


def put_latched(port: int, key: str, *texts: str) -> None:
    """Publish texts as rmw_zenoh does for a latched topic, then stay for late subscribers."""
    from zenoh import ext

    peer = peer_session(port)
    publisher = ext.declare_advanced_publisher(
        *(peer, key),
        cache=ext.CacheConfig(max_samples=len(texts)),
        publisher_detection=True,
        sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5),
    )
    node, entity = f"@ros2_lv/{key.split('/')[0]}/{peer.zid()}/0", "%/%/speaker"
    name, type_name, type_hash = key.split("/")[1:]
    tokens = [
        peer.liveliness().declare_token(text)
        for text in (
            f"{node}/0/NN/{entity}",
            f"{node}/1/MP/{entity}/%{name}/{type_name}/{type_hash}/:1:,{len(texts)}:,:,:,,",
        )
    ]
    for number, text in enumerate(texts, 1):
        data = text.encode() + b"\0"
        message = b"\0\1\0\0" + struct.pack("<I", len(data)) + data
        publisher.put(message, attachment=_attachment("new", number))
    announce("said")
    stay()
    del tokens


def hear_latched(port: int, key: str, depth: int) -> None:
    """Print texts, as rmw_zenoh asks for those of a latched topic."""
    from zenoh import ext

    peer = peer_session(port)
    kept = ext.declare_advanced_subscriber(
        *(peer, key, lambda sample: announce(f"heard {sample.payload.to_bytes()[8:-1].decode()}")),
        history=ext.HistoryConfig(detect_late_publishers=True, max_samples=depth),
        recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
        subscriber_detection=True,
    )
    stay()
    kept.undeclare()


def token(port: int, text: str) -> None:
    """Declare a token."""
    peer = peer_session(port)
    kept = peer.liveliness().declare_token(text)
    announce("declared")
    stay()
    del kept
