# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS policies by name, as in mapfiles, bridge files and JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypedDict

from rmw_manycore_py.native.enums import Durability, History, Liveliness, Reliability

if TYPE_CHECKING:
    from rmw_manycore_py.native._transport import Qos


class Policies(TypedDict, total=False):
    """Some or all policies of an endpoint. Durations in nanoseconds, None = no limit."""

    reliability: Reliability
    durability: Durability
    history: History
    depth: int
    deadline_ns: int | None
    lifespan_ns: int | None
    liveliness: Liveliness
    liveliness_lease_ns: int | None


def all_reliable(offers: Iterable[Qos]) -> bool:
    """Return whether all publishers are reliable; True for none."""
    return all(offer.reliability == "reliable" for offer in offers)


def all_transient_local(offers: Iterable[Qos]) -> bool:
    """Return whether all publishers are transient local; True for none."""
    return all(offer.durability == "transient_local" for offer in offers)


def policies_of(qos: Qos) -> Policies:
    """Return all policies of an endpoint."""
    return {
        "reliability": qos.reliability,
        "durability": qos.durability,
        "history": qos.history,
        "depth": qos.depth,
        "deadline_ns": qos.deadline_ns,
        "lifespan_ns": qos.lifespan_ns,
        "liveliness": qos.liveliness,
        "liveliness_lease_ns": qos.liveliness_lease_ns,
    }
