# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A process as a member of a platform, without ROS."""

from __future__ import annotations

import weakref
from typing import Any, TypeVar

import numpy as np

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.platforms import running_text
from rmw_manycore_py.platform.environment import (
    MAX_CLUSTER,
    MAX_CORE,
    own_cluster,
    own_core,
    own_wait_mode,
)
from rmw_manycore_py.ros.domain import checked_platform, default_platform
from rmw_manycore_py.transport.arguments import checked_name, checked_number, checked_topic
from rmw_manycore_py.transport.closing import Closing
from rmw_manycore_py.transport.errors import TransportError, native_errors
from rmw_manycore_py.transport.multi_array import TYPES, Scalar, checked_dtype
from rmw_manycore_py.transport.publisher import Publisher
from rmw_manycore_py.transport.qos import Qos, native_qos
from rmw_manycore_py.transport.subscription import Subscription

End = TypeVar("End", Publisher[Any], Subscription[Any])


class Member(Closing):
    """The membership of this process on a platform, created by `join`; safe to use from any thread.

    The tools show it as a node. It leaves the platform at the end of the `with` block; after a kill
    the platform reclaims what it held within a second. A child of fork() inherits no membership:
    there every call raises, and `join` creates a new one.

    :ivar platform: name of the platform.
    :ivar cluster: counted from 1.
    :ivar core: counted from 0; None if the process has no core.
    :ivar name: name of the node.
    """

    def __init__(
        self, process: _transport.Process, platform: str, cluster: int, core: int | None, name: str
    ) -> None:
        self.platform = platform
        self.cluster = cluster
        self.core = core
        self.name = name
        self._process: _transport.Process | None = process
        self._ends: weakref.WeakSet[Publisher[Any] | Subscription[Any]] = weakref.WeakSet()

    def __repr__(self) -> str:
        return f"<Member {self.name} of platform {self.platform}, cluster {self.cluster}>"

    def publisher(
        self, topic: str, dtype: type[Scalar] | np.dtype[Scalar], *, qos: Qos | int = 10
    ) -> Publisher[Scalar]:
        """Return a publisher of arrays.

        :param topic: full name such as /points.
        :param dtype: type of the elements: integers of 8 to 64 bits, float32, float64. Each is a
            message type of ROS 2, as std_msgs/msg/Float32MultiArray; nodes may subscribe to it.
        :param qos: policies, or only the depth of the history.
        :raises TransportError: if an argument is invalid, or the memory is exhausted.
        """
        elements = checked_dtype(dtype)
        process, name, policies = self._opened(), checked_topic(topic), native_qos(qos)
        with native_errors(name):
            native = process.publisher(name, TYPES[elements], policies)
        return self._added(Publisher(name, elements, self.platform, process, native))

    def subscription(
        self, topic: str, dtype: type[Scalar] | np.dtype[Scalar], *, qos: Qos | int = 10
    ) -> Subscription[Scalar]:
        """Return a subscription to arrays, of this interface or of ROS 2 nodes.

        The parameters are those of `publisher`.

        :raises TransportError: if an argument is invalid, or the memory is exhausted.
        """
        elements = checked_dtype(dtype)
        process, name, policies = self._opened(), checked_topic(topic), native_qos(qos)
        with native_errors(name):
            native = process.subscription(name, TYPES[elements], policies)
        return self._added(Subscription(name, elements, process, native))

    def close(self) -> None:
        """Close all publishers and subscriptions, then leave the platform; idempotent."""
        process, self._process = self._process, None
        if process is None:
            return
        for end in list(self._ends):
            end.close()
        process.close()

    def _opened(self) -> _transport.Process:
        if self._process is None:
            raise TransportError(f"{self.name} has left platform '{self.platform}'")
        return self._process

    def _added(self, end: End) -> End:
        self._ends.add(end)
        return end


def join(
    platform: str | None = None,
    *,
    cluster: int | None = None,
    core: int | None = None,
    name: str | None = None,
    create: bool = True,
) -> Member:
    """Join a platform with this process, and create it if it does not exist.

    Arguments default to environment variables, as for ROS nodes: `manycore run` sets them for each
    program that it starts.

    :param platform: by default $MANYCORE_PLATFORM, else domain-$ROS_DOMAIN_ID.
    :param cluster: counted from 1; by default $MANYCORE_CLUSTER, else 1.
    :param core: counted from 0; by default $MANYCORE_CORE, else none. The tools show it;
        the process is not pinned by it.
    :param name: name of the node; by default that of the program.
    :param create: False refuses to create a platform.
    :raises ManycoreError: if an argument or variable is invalid.
    :raises TransportError: if there is no such cluster or core, if the process has joined the
        platform elsewhere already, or, without `create`, if the platform does not exist.
    """
    if platform is not None:
        checked_platform(platform, "platform")
    found = default_platform() if platform is None else platform
    place = own_cluster() if cluster is None else checked_number("cluster", cluster, 1, MAX_CLUSTER)
    number = own_core() if core is None else checked_number("core", core, 0, MAX_CORE)
    label = checked_name(name)
    with native_errors(f"platform '{found}'"):
        if not create:
            _require_platform(found)
        process = _transport.Process(found, place, number, label, own_wait_mode())
    return Member(process, found, place, number, label)


def _require_platform(name: str) -> None:
    names = _transport.platforms()
    if name not in names:
        raise TransportError(f"there is no platform '{name}' to join; {running_text(names)}")
