# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS of a route's endpoints: compatible with all publishers of the topic."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

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


def service_qos() -> Qos:
    """Return the QoS of services in ROS 2."""
    return Qos(reliability="reliable", durability="volatile", history="keep_last", depth=10)


def replaced(qos: Qos, changes: Policies) -> Qos:
    """Return the QoS with some policies replaced."""
    policies = policies_of(qos)
    policies.update(changes)
    return Qos(**policies)


def _longest(durations_ns: Iterable[int | None]) -> int | None:
    known = list(durations_ns)
    return None if None in known or not known else max(d for d in known if d is not None)


def satisfies(present: Qos, wanted: Qos) -> bool:
    """Return whether endpoints with the current QoS satisfy the wanted one; more depth does."""
    return present.depth >= wanted.depth and present == replaced(wanted, {"depth": present.depth})
