# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ends of an action that is spoken by zenoh-ros2-sdk, as its services and topics.

The SDK knows no actions: it serializes their parts from the definitions below, where the goal,
result and feedback of an action are not nested, which their bytes do not show.
"""

from __future__ import annotations

import threading
from typing import Any

from rmw_manycore_bridge.outside.types import hash_of
from support.nodes.ros import announce
from support.nodes.serving import FIBONACCI
from support.nodes.zenoh_peers import sdk_of, stay

NESTED = {
    "unique_identifier_msgs/msg/UUID": "uint8[16] uuid",
    "builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec",
    "action_msgs/msg/GoalInfo": (
        "unique_identifier_msgs/msg/UUID goal_id\nbuiltin_interfaces/msg/Time stamp"
    ),
    "action_msgs/msg/GoalStatus": "action_msgs/msg/GoalInfo goal_info\nint8 status",
}
ID = "unique_identifier_msgs/msg/UUID goal_id"
SERVICES = {
    "send_goal": (
        f"{FIBONACCI}_SendGoal",
        f"{ID}\nint32 order",
        "bool accepted\nbuiltin_interfaces/msg/Time stamp",
    ),
    "get_result": (f"{FIBONACCI}_GetResult", ID, "int8 status\nint32[] sequence"),
    "cancel_goal": (
        "action_msgs/srv/CancelGoal",
        "action_msgs/msg/GoalInfo goal_info",
        "int8 return_code\naction_msgs/msg/GoalInfo[] goals_canceling",
    ),
}
LATCHED_ONE = ":1:,1:,:,:,,"
TOPICS: dict[str, tuple[str, str, str | None]] = {
    "feedback": (f"{FIBONACCI}_FeedbackMessage", f"{ID}\nint32[] sequence", None),
    "status": (
        *("action_msgs/msg/GoalStatusArray", "action_msgs/msg/GoalStatus[] status_list"),
        LATCHED_ONE,
    ),
}
SUCCEEDED, CANCELED = 4, 5
TIMEOUT_S = 600.0


class _Sdk:
    """The SDK, and what makes the ends of the action's parts."""

    def __init__(self, port: int, domain: int, node: str) -> None:
        self.sdk, self._to = sdk_of(port, domain)
        self._to["node_name"] = node
        session = self.sdk.ZenohSession.get_instance("127.0.0.1", port)
        self.kinds = {
            name: session.register_message_type(text, name) for name, text in NESTED.items()
        }

    def service(self, end: Any, name: str, *more: Any, **options: Any) -> Any:
        type_name, request, response = SERVICES[name]
        return end(
            *(f"/count/_action/{name}", type_name, *more),
            request_definition=request,
            response_definition=response,
            type_hash=hash_of(type_name),
            **options,
            **self._to,
        )

    def topic(self, end: Any, name: str, *more: Any) -> Any:
        type_name, definition, qos = TOPICS[name]
        return end(
            *(f"/count/_action/{name}", type_name, *more),
            msg_definition=definition,
            qos=qos,
            type_hash=hash_of(type_name),
            **self._to,
        )

    def info(self, goal_id: Any) -> Any:
        time = self.kinds["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
        return self.kinds["action_msgs/msg/GoalInfo"](goal_id=goal_id, stamp=time)


def sdk_send_goal(port: int, domain: int, cancels: bool) -> None:
    """Send a goal, cancel it if asked to, and print what comes of it."""
    import numpy as np

    made = _Sdk(port, domain, "sender")
    goal_id = made.kinds["unique_identifier_msgs/msg/UUID"](uuid=np.arange(16, dtype=np.uint8))
    heard, ended = threading.Event(), threading.Event()

    def feedback(message: Any) -> None:
        assert (message.goal_id.uuid == goal_id.uuid).all()
        announce(f"feedback {message.sequence.tolist()}")
        heard.set()

    def statuses(message: Any) -> None:
        if [one.status for one in message.status_list] == [CANCELED if cancels else SUCCEEDED]:
            ended.set()

    kept = made.topic(made.sdk.ROS2Subscriber, "feedback", feedback)
    also = made.topic(made.sdk.ROS2Subscriber, "status", statuses)
    clients = {
        name: made.service(made.sdk.ROS2ServiceClient, name, timeout=TIMEOUT_S) for name in SERVICES
    }
    for client in clients.values():
        while not client.querier.matching_status.matching:
            heard.wait(0.01)
    announce(f"accepted {clients['send_goal'].call(goal_id=goal_id, order=3).accepted}")
    heard.wait()
    if cancels:
        answer = clients["cancel_goal"].call(goal_info=made.info(goal_id))
        announce(f"canceling {len(answer.goals_canceling)}")
    result = clients["get_result"].call(goal_id=goal_id)
    ended.wait()
    announce(f"status {result.status} {result.sequence.tolist()}")
    stay()
    del kept, also


def sdk_count(port: int, domain: int) -> None:
    """Serve Fibonacci with endless feedback; goals end when they are canceled."""
    import numpy as np

    made = _Sdk(port, domain, "counter")
    feedback = made.topic(made.sdk.ROS2Publisher, "feedback")
    status = made.topic(made.sdk.ROS2Publisher, "status")
    canceled = threading.Event()
    sequence = np.array([0, 1], dtype=np.int32)

    def accept(asked: Any) -> Any:
        announce(f"order {asked.order}")
        threading.Thread(target=work, args=(asked.goal_id,), daemon=True).start()
        time = made.kinds["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
        return starter.response_msg_class(accepted=True, stamp=time)

    def work(goal_id: Any) -> None:
        while not canceled.wait(0.02):
            feedback.publish(goal_id=goal_id, sequence=sequence)
        kind = made.kinds["action_msgs/msg/GoalStatus"]
        status.publish(status_list=[kind(goal_info=made.info(goal_id), status=CANCELED)])

    def cancel(asked: Any) -> Any:
        canceled.set()
        return canceler.response_msg_class(return_code=0, goals_canceling=[asked.goal_info])

    starter = made.service(made.sdk.ROS2ServiceServer, "send_goal", accept)
    canceler = made.service(made.sdk.ROS2ServiceServer, "cancel_goal", cancel)
    results = made.service(made.sdk.ROS2ServiceServer, "get_result", mode="queue")
    announce("serving")
    key, _ = results.take_request()
    canceled.wait()
    results.send_response(key, results.response_msg_class(status=CANCELED, sequence=sequence))
    stay()
