# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS offered by publishers, in rosbag2's YAML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, cast

import yaml

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.native.enums import Durability, History, Liveliness, Reliability
from rmw_manycore_py.recording.plain_yaml import dump

_NS_PER_S = 1_000_000_000
_INFINITE = {"sec": 9223372036, "nsec": 854775807}  # RMW_DURATION_INFINITE
# Minimum seconds of "no limit", which older middlewares wrote in different ways.
_MIN_INFINITE_S = 0x7FFFFFFF
# Versions up to 8 of the format use the values of rmw/types.h.
_NUMBERS = {
    "history": {0: "system_default", 1: "keep_last", 2: "keep_all", 3: "unknown"},
    "reliability": {0: "system_default", 1: "reliable", 2: "best_effort", 3: "unknown"},
    "durability": {0: "system_default", 1: "transient_local", 2: "volatile", 3: "unknown"},
    "liveliness": {0: "system_default", 1: "automatic", 3: "manual_by_topic", 4: "unknown"},
}


def profiles_of(offers: Iterable[Qos]) -> list[dict[str, Any]]:
    """Return QoS profiles in rosbag2's format since version 9."""
    return [
        {
            "history": qos.history,
            "depth": qos.depth,
            "reliability": qos.reliability,
            "durability": qos.durability,
            "deadline": _duration(qos.deadline_ns),
            "lifespan": _duration(qos.lifespan_ns),
            "liveliness": qos.liveliness,
            "liveliness_lease_duration": _duration(qos.liveliness_lease_ns),
            "avoid_ros_namespace_conventions": False,
        }
        for qos in offers
    ]


def profiles_text(offers: Iterable[Qos]) -> str:
    """Return QoS profiles for a channel's metadata."""
    profiles = profiles_of(offers)
    return dump(profiles) if profiles else ""


def offers_in(text: str) -> list[Qos]:
    """Parse the QoS profiles of a channel's metadata, as words or numbers.

    :raises ValueError: if they are invalid.
    """
    try:
        profiles = yaml.safe_load(text) or []
        return [_offer(profile) for profile in profiles]
    except Exception as error:  # other programs may write anything here
        raise ValueError(f"no QoS profiles: {error!r}") from error


def _offer(profile: Mapping[str, Any]) -> Qos:
    history = _word("history", profile)
    reliability = _word("reliability", profile)
    durability = _word("durability", profile)
    liveliness = _word("liveliness", profile)
    # Unknown policies use defaults; DDS does not announce a publisher's history.
    return Qos(
        history=cast(History, history if history == "keep_all" else "keep_last"),
        depth=max(int(profile["depth"]), 1),
        reliability=cast(Reliability, reliability if reliability == "best_effort" else "reliable"),
        durability=cast(Durability, durability if durability == "transient_local" else "volatile"),
        deadline_ns=_nanoseconds(profile["deadline"]),
        lifespan_ns=_nanoseconds(profile["lifespan"]),
        liveliness=cast(Liveliness, liveliness if liveliness == "manual_by_topic" else "automatic"),
        liveliness_lease_ns=_nanoseconds(profile["liveliness_lease_duration"]),
    )


def _word(policy: str, profile: Mapping[str, Any]) -> str:
    value = profile[policy]
    return _NUMBERS[policy].get(value, "unknown") if isinstance(value, int) else str(value)


def _duration(ns: int | None) -> dict[str, int]:
    if ns is None:
        return _INFINITE
    seconds, rest = divmod(ns, _NS_PER_S)
    return {"sec": seconds, "nsec": rest}


def _nanoseconds(duration: Mapping[str, int]) -> int | None:
    seconds, rest = int(duration["sec"]), int(duration["nsec"])
    if seconds >= _MIN_INFINITE_S or not (seconds or rest):
        return None
    return seconds * _NS_PER_S + rest
