# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traces in the Common Trace Format, with the events and contexts of ros2_tracing under LTTng."""

from __future__ import annotations

import struct
import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

MS = 1_000_000
NODE, PUBLISHER, SUBSCRIPTION, TIMER = 0x10, 0x20, 0x30, 0x40
FROM_TOPIC, FROM_TIMER = 0x50, 0x60  # callbacks
SYMBOL = 'f<{lambda()#1}, {lambda()#2}>::operator()("a")'

# Fields of each event: x is an address, d a number, s a text.
EVENTS = {
    "ros2:rcl_init": "context_handle:x version:s",
    "ros2:rcl_node_init": "node_handle:x rmw_handle:x node_name:s namespace:s",
    "ros2:rcl_publisher_init": "publisher_handle:x node_handle:x topic_name:s queue_depth:d",
    "ros2:rcl_subscription_init": "subscription_handle:x node_handle:x topic_name:s queue_depth:d",
    "ros2:rclcpp_subscription_init": "subscription_handle:x subscription:x",
    "ros2:rclcpp_subscription_callback_added": "subscription:x callback:x",
    "ros2:rcl_service_init": "service_handle:x node_handle:x service_name:s",
    "ros2:rclcpp_service_callback_added": "service_handle:x callback:x",
    "ros2:rcl_timer_init": "timer_handle:x period:d",
    "ros2:rclcpp_timer_callback_added": "timer_handle:x callback:x",
    "ros2:rclcpp_timer_link_node": "timer_handle:x node_handle:x",
    "ros2:rclcpp_callback_register": "callback:x symbol:s",
    "ros2:callback_start": "callback:x is_intra_process:d",
    "ros2:callback_end": "callback:x",
    "ros2:rcl_publish": "publisher_handle:x message:x",
    "ros2_caret:construct_executor": "executor_addr:x executor_type_name:s",
    "ros2_caret:add_callback_group": "executor_addr:x callback_group_addr:x group_type_name:s",
    "ros2_caret:callback_group_add_subscription": "callback_group_addr:x subscription_handle:x",
    "lttng_ust_statedump:start": "",
}
_TYPES = {
    "x": "integer { size = 64; align = 8; signed = false; base = 16; }",
    "d": "integer { size = 64; align = 8; signed = true; base = 10; }",
    "s": "string",
}
_HEAD = """/* CTF 1.8 */
typealias integer {{ size = 16; align = 8; signed = false; }} := uint16_t;
typealias integer {{ size = 32; align = 8; signed = false; }} := uint32_t;
typealias integer {{ size = 64; align = 8; signed = false; }} := uint64_t;
trace {{
  major = 1; minor = 8; byte_order = le; uuid = "{uuid}";
  packet.header := struct {{ uint32_t magic; integer {{ size = 8; align = 8; }} uuid[16];
                            uint32_t stream_id; }};
}};
env {{ hostname = "{host}"; domain = "ust"; tracer_name = "lttng-ust"; tracer_major = 2;
      tracer_minor = 11; }};
clock {{ name = monotonic; freq = 1000000000; offset_s = 1600000000; }};
typealias integer {{ size = 64; align = 8; map = clock.monotonic.value; }} := time_t;
stream {{
  id = 0;
  packet.context := struct {{ time_t timestamp_begin; time_t timestamp_end; uint64_t content_size;
                             uint64_t packet_size; uint64_t events_discarded; uint32_t cpu_id; }};
  event.header := struct {{ uint16_t id; time_t timestamp; }};
  event.context := struct {{ {context} }};
}};
"""
_SIGNED = "integer { size = 32; align = 8; signed = true; }"
CONTEXT = f"string _procname; {_SIGNED} _vpid; {_SIGNED} _vtid;"


class Made(NamedTuple):
    """An event."""

    time_ns: int
    name: str
    pid: int
    tid: int
    fields: dict[str, Any]


def made(time_ns: int, name: str, pid: int, tid: int, /, **fields: Any) -> Made:
    name = name if ":" in name else f"ros2:{name}"
    return Made(time_ns, name, pid, tid, fields)


def node(pid: int, name: str, at: int = NODE, topic: str = "/out") -> list[Made]:
    """Return the init events of a node with a publisher, at time 0."""
    return [
        made(0, "rcl_publisher_init", pid, pid, publisher_handle=at + 1, node_handle=at,
             topic_name="/rosout", queue_depth=1000),
        made(0, "rcl_node_init", pid, pid, node_handle=at, node_name=name, namespace="/ns"),
        made(0, "rcl_publisher_init", pid, pid, publisher_handle=PUBLISHER + at, node_handle=at,
             topic_name=topic, queue_depth=3),
    ]  # fmt: skip


def subscription(pid: int, topic: str, callback: int = FROM_TOPIC, at_ns: int = 0) -> list[Made]:
    """Return the init events of a subscription, in the order of rclcpp with intra-process."""
    return [
        made(at_ns, "rcl_subscription_init", pid, pid, subscription_handle=SUBSCRIPTION,
             node_handle=NODE, topic_name=topic, queue_depth=7),
        made(at_ns, "rclcpp_subscription_callback_added", pid, pid, subscription=SUBSCRIPTION + 1,
             callback=callback),
        made(at_ns, "rclcpp_callback_register", pid, pid, callback=callback, symbol=SYMBOL),
        made(at_ns, "rclcpp_subscription_init", pid, pid, subscription_handle=SUBSCRIPTION,
             subscription=SUBSCRIPTION + 1),
    ]  # fmt: skip


def timer(pid: int) -> list[Made]:
    return [
        made(0, "rcl_timer_init", pid, pid, timer_handle=TIMER, period=20 * MS),
        made(0, "rclcpp_timer_callback_added", pid, pid, timer_handle=TIMER, callback=FROM_TIMER),
        made(0, "rclcpp_timer_link_node", pid, pid, timer_handle=TIMER, node_handle=NODE),
    ]


def begin(ms: float, pid: int, tid: int, callback: int) -> Made:
    return made(round(ms * MS), "callback_start", pid, tid, callback=callback)


def end(ms: float, pid: int, tid: int, callback: int) -> Made:
    return made(round(ms * MS), "callback_end", pid, tid, callback=callback)


def published(ms: float, pid: int, tid: int, at: int = NODE) -> Made:
    return made(round(ms * MS), "rcl_publish", pid, tid, publisher_handle=PUBLISHER + at)


def write_trace(
    directory: Path,
    *packets: Sequence[Made],
    discarded: int = 0,
    context: str = CONTEXT,
    host: str = "host",
) -> Path:
    """Write a trace with some packets, after the first of which events were discarded."""
    directory.mkdir(parents=True, exist_ok=True)
    own = uuid.uuid4()
    text = _HEAD.format(uuid=own, context=context, host=host)
    for number, (name, fields) in enumerate(EVENTS.items()):
        pairs = (field.split(":") for field in fields.split())
        declared = " ".join(f"{_TYPES[kind]} _{field};" for field, kind in pairs)
        text += f'event {{ name = "{name}"; id = {number}; stream_id = 0;\n'
        text += f"  fields := struct {{ {declared} }}; }};\n"
    (directory / "metadata").write_text(text)
    with (directory / "stream_0").open("wb") as file:
        for index, packet in enumerate(packets):
            file.write(_packet(packet, own.bytes, discarded if index else 0, context))
    return directory


def _packet(events: Sequence[Made], own: bytes, discarded: int, context: str) -> bytes:
    content = b"".join(_event(event, context) for event in events)
    head = struct.pack("<I16sI", 0xC1FC1FC1, own, 0)
    times = events[0].time_ns, events[-1].time_ns
    bits = 8 * (len(head) + 44 + len(content))
    return head + struct.pack("<QQQQQI", *times, bits, bits, discarded, 0) + content


def _event(event: Made, context: str) -> bytes:
    ids = list(EVENTS)
    packed = struct.pack("<HQ", ids.index(event.name), event.time_ns)
    packed += f"process {event.pid}".encode() + b"\0"
    if "_vpid" in context:
        packed += struct.pack("<ii", event.pid, event.tid)
    for field in EVENTS[event.name].split():
        name, _, kind = field.partition(":")
        value = event.fields.get(name, "" if kind == "s" else 0)
        if kind == "s":
            packed += value.encode() + b"\0"
        else:
            packed += struct.pack("<Q" if kind == "x" else "<q", value)
    return packed
