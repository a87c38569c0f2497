# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Membership of a DDS domain: rclpy context and node, and a wait set of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from rmw_manycore_bridge.fastdds import rcl

_GRAPH, _WAKE = 0, 1  # indices of the guard conditions in the wait set
_NS_PER_S = 1e9
# Node name of an endpoint that DDS has announced but rmw_dds_common has not attributed yet.
_UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"


class Domain:
    """Waits for messages and graph changes in a DDS domain.

    :ivar readers: called when their key has something: a subscription, service or client, of which
        `kind` and `entity` are for the wait set.
    """

    def __init__(
        self,
        domain: int,
        name: str,
        changed: Callable[[], None],
        is_own: Callable[[bytes], bool],
    ) -> None:
        self._is_own = is_own
        self.context = rclpy.Context()
        rclpy.init(
            args=[],
            context=self.context,
            domain_id=domain,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self.node = _quiet_node(name, self.context)
        self._stand_ins: dict[str, tuple[Node, int]] = {}  # with the number of their services
        self.readers: dict[Any, Callable[[], None]] = {}
        self._changed = changed
        with self.context.handle:
            self._wake = _rclpy.GuardCondition(self.context.handle)

    def publishers(self, topic: str) -> list[Any]:
        """Return the publishers of a topic, except this bridge's."""
        return self._others(self.node.get_publishers_info_by_topic(topic))

    def subscriptions(self, topic: str) -> list[Any]:
        """Return the subscriptions of a topic, except this bridge's."""
        return self._others(self.node.get_subscriptions_info_by_topic(topic))

    def published(self, wanted: Callable[[str], bool]) -> dict[str, frozenset[str]]:
        """Return the types published by others than this bridge, by topic name."""
        names = [name for name, _ in self.node.get_topic_names_and_types() if wanted(name)]
        found = {name: frozenset(p.topic_type for p in self.publishers(name)) for name in names}
        return {name: types for name, types in found.items() if types}

    def server_types(self, service: str) -> list[str]:
        """Return the types of a service's servers, except this bridge's.

        rmw lists service types by name only, servers and clients mixed; so query the subscriptions
        of the request topic, by its DDS topic and type names.
        """
        name = f"rq{service}Request"
        endpoints = self.node.get_subscriptions_info_by_topic(name, no_mangle=True)
        return [service_type_of(e.topic_type) for e in self._others(endpoints)]

    def _others(self, endpoints: list[Any]) -> list[Any]:
        own = self.node.get_name().rpartition("_")[0]
        return [
            e
            for e in endpoints
            if e.node_name.rpartition("_")[0] != own
            and full_name_of(e) not in self._stand_ins
            and not self._is_own_newcomer(e)
        ]

    def _is_own_newcomer(self, endpoint: Any) -> bool:
        """Return whether an endpoint with a still unknown node is a publisher of this bridge."""
        return endpoint.node_name == _UNKNOWN_NODE and self._is_own(bytes(endpoint.endpoint_gid))

    def enter_node(self, full_name: str | None) -> Node:
        """Return a node of that name for one more service; without a name, the bridge's own node.

        Tools look up a node before they query its parameters.
        """
        if full_name is None:
            return self.node
        node, users = self._stand_ins.get(full_name, (None, 0))
        if node is None:
            namespace, _, name = full_name.rpartition("/")
            node = _quiet_node(name, self.context, namespace or "/")
        self._stand_ins[full_name] = node, users + 1
        return node

    def leave_node(self, full_name: str | None) -> None:
        """Release a node from `enter_node`; destroy it with its last service."""
        if full_name is not None:
            node, users = self._stand_ins.pop(full_name)
            if users > 1:
                self._stand_ins[full_name] = node, users - 1
            else:
                node.destroy_node()

    def wake(self) -> None:
        """Interrupt the current or next wait. Thread-safe."""
        self._wake.trigger_guard_condition()

    def turn(self, timeout_s: float | None) -> None:
        """Block until something changes, then forward what has arrived."""
        readers = list(self.readers.items())
        wait_set = self._new_wait_set([reader for reader, _ in readers])
        wait_set.wait(-1 if timeout_s is None else int(timeout_s * _NS_PER_S))
        if wait_set.is_ready("guard_condition", _GRAPH):
            self._changed()
        indices = {"subscription": 0, "service": 0, "client": 0}
        for reader, pump in readers:
            index = indices[reader.kind]
            indices[reader.kind] += 1
            if wait_set.is_ready(reader.kind, index):
                pump()

    def _new_wait_set(self, readers: list[Any]) -> Any:
        counts = {kind: sum(r.kind == kind for r in readers) for kind in _KINDS}
        wait_set = self._wait_set_of(counts)
        wait_set.clear_entities()
        rcl.add_graph_of(self.node, wait_set)
        wait_set.add_guard_condition(self._wake)
        for reader in readers:
            getattr(wait_set, f"add_{reader.kind}")(reader.entity.handle)
        return wait_set

    def _wait_set_of(self, counts: dict[str, int]) -> Any:
        if getattr(self, "_counts", None) != counts:
            self._counts = counts
            with self.context.handle:
                self._wait_set = _rclpy.WaitSet(
                    *(counts["subscription"], 2, 0, counts["client"], counts["service"], 0),
                    self.context.handle,
                )
        return self._wait_set

    def close(self) -> None:
        """Leave the domain."""
        self.readers.clear()
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)


def full_name_of(endpoint: Any) -> str:
    """Return /namespace/name of an endpoint's node."""
    return f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}"


def service_type_of(request_type: str) -> str:
    """Return a service type from its DDS request type.

    >>> service_type_of("std_srvs::srv::dds_::SetBool_Request_")
    'std_srvs/srv/SetBool'
    """
    return request_type.replace("dds_::", "").removesuffix("_Request_").replace("::", "/")


_KINDS = ("subscription", "service", "client")


def _quiet_node(name: str, context: rclpy.Context, namespace: str = "/") -> Node:
    """Return a node with as few endpoints as rclpy allows."""
    return rclpy.create_node(
        name,
        context=context,
        namespace=namespace,
        enable_rosout=False,
        start_parameter_services=False,
        use_global_arguments=False,
        parameter_overrides=[Parameter("start_type_description_service", value=False)],
    )
