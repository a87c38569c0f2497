# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The QoS of a route's endpoints: what all publishers offer, so that all of them are heard.

Policies are mappings as in the registry: words for kinds, nanoseconds for times, None = no limit.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from rclpy.duration import Duration, Infinite
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

Policies = dict[str, Any]

# A burst of this many messages waits for the bridge; more where the other side keeps more.
LEAST_DEPTH = 10


def common_offer(offers: Iterable[Mapping[str, Any]], overrides: Mapping[str, Any]) -> Policies:
    """Return the strongest offer that none of the publishers falls short of.

    The depths add up: a late subscriber of a latched topic gets what each publisher has kept.
    """
    all_offers = list(offers)
    reliable = all(offer["reliability"] == "reliable" for offer in all_offers)
    kept = all(offer["durability"] == "transient_local" for offer in all_offers)
    by_hand = any(offer["liveliness"] == "manual_by_topic" for offer in all_offers)
    return {
        "reliability": "reliable" if reliable else "best_effort",
        "durability": "transient_local" if kept else "volatile",
        "history": "keep_last",
        "depth": sum(offer["depth"] for offer in all_offers) or 1,
        "deadline_ns": _longest(offer["deadline_ns"] for offer in all_offers),
        "lifespan_ns": _longest(offer["lifespan_ns"] for offer in all_offers),
        "liveliness": "manual_by_topic" if by_hand else "automatic",
        "liveliness_lease_ns": _longest(offer["liveliness_lease_ns"] for offer in all_offers),
        **overrides,
    }


def unmet(offers: Iterable[Mapping[str, Any]], overrides: Mapping[str, Any]) -> str | None:
    """Return what a route asks for that none of the publishers offers; else nothing."""
    found = list(offers)
    for policy, strong in (("reliability", "reliable"), ("durability", "transient_local")):
        if overrides.get(policy) == strong and all(offer[policy] != strong for offer in found):
            return f"its qos asks for {policy} {strong}, the publisher offers {found[0][policy]}"
    return None


def request_for(offer: Mapping[str, Any], depth: int) -> Policies:
    """Return what a subscription asks of publishers with that offer; nothing expires in it."""
    kept = max(offer["depth"], LEAST_DEPTH, depth)
    return {**offer, "history": "keep_last", "depth": kept, "lifespan_ns": None}


def _longest(durations_ns: Iterable[int | None]) -> int | None:
    known = list(durations_ns)
    return None if None in known or not known else max(d for d in known if d is not None)


def from_rclpy(profile: QoSProfile) -> Policies:
    """Return what a publisher outside offers.

    DDS does not tell others how much history a publisher keeps: it counts as one message.
    """
    reliable = profile.reliability == ReliabilityPolicy.RELIABLE
    kept = profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    by_hand = profile.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
    return {
        "reliability": "reliable" if reliable else "best_effort",
        "durability": "transient_local" if kept else "volatile",
        "history": "keep_last",
        "depth": max(profile.depth, 1),
        "deadline_ns": _ns(profile.deadline),
        "lifespan_ns": _ns(profile.lifespan),
        "liveliness": "manual_by_topic" if by_hand else "automatic",
        "liveliness_lease_ns": _ns(profile.liveliness_lease_duration),
    }


def to_rclpy(policies: Mapping[str, Any]) -> QoSProfile:
    """Return the same for an endpoint outside."""
    reliable = policies["reliability"] == "reliable"
    kept = policies["durability"] == "transient_local"
    by_hand = policies["liveliness"] == "manual_by_topic"
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
        history=HistoryPolicy.KEEP_ALL
        if policies["history"] == "keep_all"
        else HistoryPolicy.KEEP_LAST,
        depth=policies["depth"],
        deadline=_duration(policies["deadline_ns"]),
        lifespan=_duration(policies["lifespan_ns"]),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC if by_hand else LivelinessPolicy.AUTOMATIC,
        liveliness_lease_duration=_duration(policies["liveliness_lease_ns"]),
    )


def _ns(duration: Duration) -> int | None:
    """Middlewares write "no limit" as zero or as their longest duration."""
    ns = int(duration.nanoseconds)
    return None if ns == 0 or ns >= int(Infinite.nanoseconds) else ns


def _duration(ns: int | None) -> Duration:
    return Infinite if ns is None else Duration(nanoseconds=ns)


def satisfies(present: Mapping[str, Any], wanted: Mapping[str, Any]) -> bool:
    """Tell whether endpoints with the present offer do for the wanted one; more depth does."""
    depths = {"depth": present["depth"]}
    return present["depth"] >= wanted["depth"] and dict(present) == {**wanted, **depths}
