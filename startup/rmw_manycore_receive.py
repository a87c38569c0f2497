# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chooses how the subscriptions of an unmodified rclpy node are served: `receive` of a mapfile.

ROS-lite has two designs for it. `queue` (its Fig. 10): one callback queue, so callbacks of
subscriptions never overlap. `per_topic` (its Fig. 8): a function per topic, which runs as soon as
a message is there, whatever the others do. See docs/design/run.md.

Imports nothing that python has not imported by then: this runs before everything else.
"""

from __future__ import annotations

from rmw_manycore_loading import refuse_rclpy

TYPE_CHECKING = False  # as typing has it, without importing typing
if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType
    from typing import Any

VARIABLE = "MANYCORE_RECEIVE"
QUEUE, PER_TOPIC = "queue", "per_topic"
MAX_THREADS = 64  # of an executor; python starts one only when all others are busy


def changes(design: str) -> dict[str, Callable[[ModuleType], None]]:
    """Return what a design changes in rclpy, by module; an unknown one refuses to load it."""
    if design == QUEUE:
        return {"rclpy.node": _share_group}
    if design == PER_TOPIC:
        return {"rclpy.node": _give_groups, "rclpy.executors": _give_threads}
    return {"rclpy": refuse_rclpy(VARIABLE, design, QUEUE, PER_TOPIC)}


def _share_group(node: ModuleType) -> None:
    """Put all subscriptions of the process into one group of callbacks that exclude each other."""
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

    group = MutuallyExclusiveCallbackGroup()
    _choose_group(node, lambda _: group)


def _give_groups(node: ModuleType) -> None:
    """Give each subscription a group of its own, unless the program has chosen one."""
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

    _choose_group(node, lambda group: group or MutuallyExclusiveCallbackGroup())


def _choose_group(node: ModuleType, choose: Callable[[Any], Any]) -> None:
    from functools import wraps

    original: Callable[..., Any] = node.Node.create_subscription

    @wraps(original)
    def create_subscription(self: object, *most: Any, **named: Any) -> Any:
        named["callback_group"] = choose(named.get("callback_group"))
        return original(self, *most, **named)

    node.Node.create_subscription = create_subscription


def _give_threads(executors: ModuleType) -> None:
    """Have the executor of `rclpy.spin` serve callbacks on threads."""

    class PerTopicExecutor(executors.MultiThreadedExecutor):  # type: ignore[misc,name-defined]
        """An executor whose callbacks wait for each other only where their groups demand it."""

        def __init__(self, *, context: Any = None) -> None:
            super().__init__(MAX_THREADS, context=context)

    executors.__dict__["SingleThreadedExecutor"] = PerTopicExecutor
