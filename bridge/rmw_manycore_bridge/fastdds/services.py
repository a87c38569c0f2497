# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Servers and clients in a DDS domain; rclpy deserializes what they carry."""

from __future__ import annotations

from typing import Any

from rclpy.serialization import deserialize_message, serialize_message

from rmw_manycore_bridge.fastdds.domain import Domain
from rmw_manycore_bridge.fastdds.topics import never_called
from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Answer
from rmw_manycore_py.routes.route import Route


class DdsServer:
    """Server in a domain, on a node of the route's name if it has one."""

    kind = "service"

    def __init__(self, domain: Domain, route: Route) -> None:
        self._domain, self._node_name = domain, route.node
        self._type = types.load(route.type)
        self._node = domain.enter_node(route.node)
        try:
            self.entity: Any = self._node.create_service(self._type, route.outside, never_called)
        except Exception:
            domain.leave_node(route.node)
            raise

    def take(self) -> tuple[Any, bytes] | None:
        """Take the next request."""
        request, header = self.entity.handle.service_take_request(self._type.Request)
        return None if request is None else (header, serialize_message(request))

    def reply(self, caller: Any, data: bytes) -> None:
        """Send a response."""
        response = deserialize_message(data, self._type.Response)
        self.entity.handle.service_send_response(response, caller.request_id)

    def close(self) -> None:
        """Destroy it."""
        self._node.destroy_service(self.entity)
        self._domain.leave_node(self._node_name)


class DdsClient:
    """Client in a domain."""

    kind = "client"

    def __init__(self, domain: Domain, route: Route) -> None:
        self._domain = domain
        self._type = types.load(route.type)
        self.entity: Any = domain.node.create_client(self._type, route.outside)

    def is_ready(self) -> bool:
        """Return whether a server is matched."""
        return bool(self.entity.service_is_ready())

    def send(self, data: bytes) -> int:
        """Send a request."""
        request = deserialize_message(data, self._type.Request)
        return int(self.entity.handle.send_request(request))

    def take(self) -> Answer | None:
        """Take the next answer."""
        header, response = self.entity.handle.take_response(self._type.Response)
        if response is None:
            return None
        return Answer(header.request_id.sequence_number, serialize_message(response))

    def close(self) -> None:
        """Destroy it."""
        self._domain.node.destroy_client(self.entity)
