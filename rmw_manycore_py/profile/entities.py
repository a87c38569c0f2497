# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes, publishers, subscriptions, timers and services that the init events of a trace name.

Events refer to entities by address. An address means something within one process only, and until
a later entity of that process gets it: each event is resolved by what is there when it comes.
"""

from __future__ import annotations

from collections.abc import Callable

from rmw_manycore_py.profile.babeltrace import Event
from rmw_manycore_py.profile.seen import (
    Address,
    ExecutorSeen,
    GroupSeen,
    NodeSeen,
    PublisherSeen,
    Registration,
    TriggerSeen,
)

_UNKNOWN = TriggerSeen("unknown")


class _Fields:
    """The fields of an init event."""

    def __init__(self, event: Event) -> None:
        self._fields = event.fields()
        self._pid = event.thread.pid

    def text(self, name: str) -> str:
        return str(self._fields.get(name, ""))

    def number(self, name: str) -> int:
        value = self._fields.get(name)
        return value if isinstance(value, int) else 0

    def at(self, name: str) -> Address:
        return self._pid, self.number(name)


class Entities:
    """All entities of a trace, up to the last event that was handled."""

    def __init__(self) -> None:
        self.nodes: list[NodeSeen] = []
        self.publishers: list[PublisherSeen] = []
        self.subscriptions: list[TriggerSeen] = []
        self.executors: list[ExecutorSeen] = []
        self.groups: list[GroupSeen] = []
        self._nodes: dict[Address, NodeSeen] = {}
        self._before_node: dict[Address, PublisherSeen] = {}
        self._publishers: dict[Address, PublisherSeen] = {}
        self._triggers: dict[Address, TriggerSeen] = {}  # by the handle of rcl
        self._handles: dict[Address, Address] = {}  # of subscriptions of rclcpp
        self._registrations: dict[Address, Registration] = {}
        self._executors: dict[Address, ExecutorSeen] = {}
        self._groups: dict[Address, GroupSeen] = {}
        self._handlers: dict[str, Callable[[_Fields], None]] = {
            "ros2:rcl_node_init": self._add_node,
            "ros2:rcl_publisher_init": self._add_publisher,
            "ros2:rcl_subscription_init": self._add_subscription,
            "ros2:rclcpp_subscription_init": self._wrap_subscription,
            "ros2:rclcpp_subscription_callback_added": self._register_of_subscription,
            "ros2:rcl_timer_init": self._add_timer,
            "ros2:rclcpp_timer_link_node": self._link_timer,
            "ros2:rclcpp_timer_callback_added": self._register_of_timer,
            "ros2:rcl_service_init": self._add_service,
            "ros2:rclcpp_service_callback_added": self._register_of_service,
            "ros2:rclcpp_callback_register": self._name_callback,
            "ros2_caret:construct_executor": self._add_executor,
            "ros2_caret:add_callback_group": self._add_group,
            "ros2_caret:callback_group_add_subscription": self._group_subscription,
            "ros2_caret:callback_group_add_timer": self._group_timer,
            "ros2_caret:callback_group_add_service": self._group_service,
        }

    def handle(self, event: Event) -> None:
        """Take note of an init event; ignores other events."""
        handler = self._handlers.get(event.name)
        if handler is not None:
            handler(_Fields(event))

    def publisher(self, handle: Address) -> PublisherSeen | None:
        """Return the publisher that is now at an address."""
        return self._publishers.get(handle)

    def registration(self, callback: Address) -> Registration | None:
        """Return the entity now registered at a callback's address."""
        return self._registrations.get(callback)

    def trigger(self, registration: Registration | None) -> TriggerSeen:
        """Return what triggers a callback."""
        if registration is None:
            return _UNKNOWN
        owner = registration.owner
        handle = self._handles.get(owner) if registration.is_subscription else owner
        return _UNKNOWN if handle is None else self._triggers.get(handle, _UNKNOWN)

    def _add_node(self, fields: _Fields) -> None:
        address = fields.at("node_handle")
        name = f"{fields.text('namespace').rstrip('/')}/{fields.text('node_name')}"
        node = NodeSeen(len(self.nodes), name, address[0])
        self.nodes.append(node)
        self._nodes[address] = node
        rosout = self._before_node.pop(address, None)
        if rosout is not None:
            rosout.node, node.has_rosout = node, True

    def _add_publisher(self, fields: _Fields) -> None:
        at_node = fields.at("node_handle")
        node = self._nodes.get(at_node)
        topic, depth = fields.text("topic_name"), fields.number("queue_depth")
        publisher = PublisherSeen(len(self.publishers), node, topic, depth)
        self.publishers.append(publisher)
        self._publishers[fields.at("publisher_handle")] = publisher
        if topic == "/rosout":
            self._add_rosout(publisher, at_node)

    def _add_rosout(self, publisher: PublisherSeen, at_node: Address) -> None:
        """Up to ROS 2 Iron, a node has this publisher before the node's own event."""
        if publisher.node is None or publisher.node.has_rosout:
            publisher.node = None
            self._before_node[at_node] = publisher
        else:
            publisher.node.has_rosout = True

    def _add_subscription(self, fields: _Fields) -> None:
        subscription = TriggerSeen(
            "subscription",
            self._nodes.get(fields.at("node_handle")),
            fields.text("topic_name"),
            index=len(self.subscriptions),
            queue_depth=fields.number("queue_depth"),
        )
        self.subscriptions.append(subscription)
        self._triggers[fields.at("subscription_handle")] = subscription

    def _wrap_subscription(self, fields: _Fields) -> None:
        self._handles[fields.at("subscription")] = fields.at("subscription_handle")

    def _add_timer(self, fields: _Fields) -> None:
        timer = TriggerSeen("timer", period_ns=fields.number("period"))
        self._triggers[fields.at("timer_handle")] = timer

    def _link_timer(self, fields: _Fields) -> None:
        timer = self._triggers.get(fields.at("timer_handle"))
        if timer is not None:
            timer.node = self._nodes.get(fields.at("node_handle"))

    def _add_service(self, fields: _Fields) -> None:
        node = self._nodes.get(fields.at("node_handle"))
        service = TriggerSeen("service", node, fields.text("service_name"))
        self._triggers[fields.at("service_handle")] = service

    def _register_of_subscription(self, fields: _Fields) -> None:
        registration = Registration(fields.at("subscription"), True)
        self._registrations[fields.at("callback")] = registration

    def _register_of_timer(self, fields: _Fields) -> None:
        registration = Registration(fields.at("timer_handle"), False)
        self._registrations[fields.at("callback")] = registration

    def _register_of_service(self, fields: _Fields) -> None:
        registration = Registration(fields.at("service_handle"), False)
        self._registrations[fields.at("callback")] = registration

    def _name_callback(self, fields: _Fields) -> None:
        registration = self._registrations.get(fields.at("callback"))
        if registration is not None:
            registration.symbol = fields.text("symbol")

    def _add_executor(self, fields: _Fields) -> None:
        executor = ExecutorSeen(len(self.executors), fields.text("executor_type_name"))
        self.executors.append(executor)
        self._executors[fields.at("executor_addr")] = executor

    def _add_group(self, fields: _Fields) -> None:
        address = fields.at("callback_group_addr")
        kind, executor = fields.text("group_type_name"), fields.at("executor_addr")
        group = self._group_at(address)
        group.kind, group.executor = kind, self._executors.get(executor)

    def _group_at(self, address: Address) -> GroupSeen:
        """Return the group at an address; entities join it before an executor has it."""
        group = self._groups.get(address)
        if group is None:
            group = self._groups[address] = GroupSeen(len(self.groups), "", None)
            self.groups.append(group)
        return group

    def _group_subscription(self, fields: _Fields) -> None:
        self._join_group(fields, "subscription_handle")

    def _group_timer(self, fields: _Fields) -> None:
        self._join_group(fields, "timer_handle")

    def _group_service(self, fields: _Fields) -> None:
        self._join_group(fields, "service_handle")

    def _join_group(self, fields: _Fields, handle: str) -> None:
        trigger = self._triggers.get(fields.at(handle))
        if trigger is not None:
            trigger.group = self._group_at(fields.at("callback_group_addr"))
