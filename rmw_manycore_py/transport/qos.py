# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The quality of service of publishers and subscriptions."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.enums import Durability, History, Liveliness, Reliability
from rmw_manycore_py.transport.arguments import checked_number
from rmw_manycore_py.transport.errors import TransportError

MAX_DEPTH = 1 << 20
_MAX_NS = (1 << 63) - 1


@dataclass(frozen=True)
class Qos:
    """The QoS policies of ROS 2 with their defaults; see docs/reference/qos.md.

    A publisher and a subscription match only if the publisher offers at least what the
    subscription requests.

    :param reliability: ``best_effort`` or ``reliable``.
    :param durability: ``transient_local`` delivers the publisher's history to late subscriptions.
    :param history: ``keep_last`` overwrites the oldest message; with ``keep_all`` and
        ``reliable`` the publisher waits.
    :param depth: history depth of ``keep_last``, 1 to 1,048,576.
    :param deadline_ns: maximum time between two messages; None means no limit, also below.
    :param lifespan_ns: messages older than this are dropped.
    :param liveliness: ``automatic`` or ``manual_by_topic``.
    :param liveliness_lease_ns: time without an assertion after which a publisher is not alive.
    """

    reliability: Reliability = "reliable"
    durability: Durability = "volatile"
    history: History = "keep_last"
    depth: int = 10
    deadline_ns: int | None = None
    lifespan_ns: int | None = None
    liveliness: Liveliness = "automatic"
    liveliness_lease_ns: int | None = None


def native_qos(qos: Qos | int) -> _transport.Qos:
    """Return the native policies; a number is a depth.

    :raises TransportError: if a policy does not exist, or a number is out of range.
    """
    policies = qos if isinstance(qos, Qos) else Qos(depth=qos)
    checked_number("depth", policies.depth, 1, MAX_DEPTH)
    for name in ("deadline_ns", "lifespan_ns", "liveliness_lease_ns"):
        duration_ns = getattr(policies, name)
        if duration_ns is not None:
            checked_number(name, duration_ns, 1, _MAX_NS)
    try:
        return _transport.Qos(**asdict(policies))
    except ValueError as error:  # a word; the message has all that there are
        raise TransportError(str(error), EXIT_BAD_INPUT) from error
