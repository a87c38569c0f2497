# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS of a route's endpoints: compatible with all publishers of the topic."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rclpy.duration import Duration, Infinite
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.ros.qos import Policies, policies_of

# Minimum queue depth of the bridge, in messages; a larger depth of the other side raises it.
MIN_DEPTH = 10


def common_offer(offers: Iterable[Qos], overrides: Policies) -> Qos:
    """Return the strongest QoS that every publisher offers.

    Depths add up: a late joiner of a latched topic gets the history of each publisher.
    """
    all_offers = list(offers)
    reliable = all(offer.reliability == "reliable" for offer in all_offers)
    kept = all(offer.durability == "transient_local" for offer in all_offers)
    by_hand = any(offer.liveliness == "manual_by_topic" for offer in all_offers)
    offer = Qos(
        reliability="reliable" if reliable else "best_effort",
        durability="transient_local" if kept else "volatile",
        history="keep_last",
        depth=sum(offer.depth for offer in all_offers) or 1,
        deadline_ns=_longest(offer.deadline_ns for offer in all_offers),
        lifespan_ns=_longest(offer.lifespan_ns for offer in all_offers),
        liveliness="manual_by_topic" if by_hand else "automatic",
        liveliness_lease_ns=_longest(offer.liveliness_lease_ns for offer in all_offers),
    )
    return replaced(offer, overrides)


def unmet(offers: Iterable[Qos], overrides: Policies) -> str | None:
    """Return why the route requests more than any publisher offers; None if it does not."""
    found = list(offers)
    reliabilities, durabilities = [o.reliability for o in found], [o.durability for o in found]
    return _unmet("reliability", "reliable", overrides.get("reliability"), reliabilities) or _unmet(
        "durability", "transient_local", overrides.get("durability"), durabilities
    )


def _unmet(policy: str, strong: str, asked: str | None, offered: Sequence[str]) -> str | None:
    if asked != strong or strong in offered:
        return None
    return f"its qos requests {policy} {strong}, the publisher offers {offered[0]}"


def request_for(offer: Qos, depth: int) -> Qos:
    """Return the QoS of a subscription that matches such publishers, without lifespan."""
    kept = max(offer.depth, MIN_DEPTH, depth)
    return replaced(offer, {"history": "keep_last", "depth": kept, "lifespan_ns": None})


def replaced(qos: Qos, changes: Policies) -> Qos:
    """Return the QoS with some policies replaced."""
    policies = policies_of(qos)
    policies.update(changes)
    return Qos(**policies)


def _longest(durations_ns: Iterable[int | None]) -> int | None:
    known = list(durations_ns)
    return None if None in known or not known else max(d for d in known if d is not None)


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


def satisfies(present: Qos, wanted: Qos) -> bool:
    """Return whether endpoints with the current QoS satisfy the wanted one; more depth does."""
    return present.depth >= wanted.depth and present == replaced(wanted, {"depth": present.depth})
