# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS of rclpy, and the policies of the platform."""

from __future__ import annotations

from rclpy.duration import Duration, Infinite
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

from rmw_manycore_py.native._transport import Qos


def from_rclpy(profile: QoSProfile) -> Qos:
    """Convert the QoS of a DDS publisher.

    DDS discovery does not carry the history depth of a publisher: assume one message.
    """
    reliable = profile.reliability == ReliabilityPolicy.RELIABLE
    kept = profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    by_hand = profile.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
    return Qos(
        reliability="reliable" if reliable else "best_effort",
        durability="transient_local" if kept else "volatile",
        history="keep_last",
        depth=max(profile.depth, 1),
        deadline_ns=_ns(profile.deadline),
        lifespan_ns=_ns(profile.lifespan),
        liveliness="manual_by_topic" if by_hand else "automatic",
        liveliness_lease_ns=_ns(profile.liveliness_lease_duration),
    )


def to_rclpy(qos: Qos) -> QoSProfile:
    """Convert to the rclpy QoS of a DDS endpoint."""
    reliable = qos.reliability == "reliable"
    kept = qos.durability == "transient_local"
    by_hand = qos.liveliness == "manual_by_topic"
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
        history=HistoryPolicy.KEEP_ALL if qos.history == "keep_all" else HistoryPolicy.KEEP_LAST,
        depth=qos.depth,
        deadline=_duration(qos.deadline_ns),
        lifespan=_duration(qos.lifespan_ns),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC if by_hand else LivelinessPolicy.AUTOMATIC,
        liveliness_lease_duration=_duration(qos.liveliness_lease_ns),
    )


def _ns(duration: Duration) -> int | None:
    """Return nanoseconds; None for zero and for the longest duration, which both mean no limit."""
    ns = int(duration.nanoseconds)
    return None if ns == 0 or ns >= int(Infinite.nanoseconds) else ns


def _duration(ns: int | None) -> Duration:
    return Infinite if ns is None else Duration(nanoseconds=ns)
