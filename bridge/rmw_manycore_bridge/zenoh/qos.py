# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS in the tokens of rmw_zenoh: numbers of rmw/types.h, empty where they are the default."""

from __future__ import annotations

from rmw_manycore_py.native._transport import Qos

_BEST_EFFORT = "2"
_TRANSIENT_LOCAL = "1"
_KEEP_ALL = "2"
_BY_TOPIC = "3"
_DEFAULT_DEPTH = 42
_MAX_DEPTH = 1 << 20  # of the platform
_NS_PER_S = 1_000_000_000
_INFINITE_NS = 9223372036 * _NS_PER_S + 854775807


def encode(qos: Qos) -> str:
    """Return the text of a QoS.

    >>> encode(Qos(depth=10))
    '::,10:,:,:,,'
    """
    by_hand = qos.liveliness == "manual_by_topic"
    if qos.history == "keep_all":
        history = f"{_KEEP_ALL},"
    else:
        history = f",{qos.depth}" if qos.depth != _DEFAULT_DEPTH else ","
    parts = (
        "" if qos.reliability == "reliable" else _BEST_EFFORT,
        _TRANSIENT_LOCAL if qos.durability == "transient_local" else "",
        history,
        _duration(qos.deadline_ns),
        _duration(qos.lifespan_ns),
        f"{_BY_TOPIC if by_hand else ''},{_duration(qos.liveliness_lease_ns)}",
    )
    return ":".join(parts)


def decode(text: str) -> Qos:
    """Return the QoS of a text.

    :raises ValueError: if it has another format.
    """
    reliability, durability, history, deadline, lifespan, liveliness, *_ = text.split(":")
    keeps, depth = history.split(",")
    by, _, lease = liveliness.partition(",")
    for part, known in ((reliability, "012"), (durability, "012"), (keeps, "012"), (by, "0123")):
        if part and part not in known:
            raise ValueError(f"unknown policy {part}")
    return Qos(
        reliability="best_effort" if reliability == _BEST_EFFORT else "reliable",
        durability="transient_local" if durability == _TRANSIENT_LOCAL else "volatile",
        history="keep_last",  # messages of keep_all are kept up to the default depth
        depth=min(max(int(depth or _DEFAULT_DEPTH), 1), _MAX_DEPTH),
        deadline_ns=_ns(deadline),
        lifespan_ns=_ns(lifespan),
        liveliness="manual_by_topic" if by == _BY_TOPIC else "automatic",
        liveliness_lease_ns=_ns(lease),
    )


def _duration(ns: int | None) -> str:
    return "," if ns is None else f"{ns // _NS_PER_S},{ns % _NS_PER_S}"


def _ns(text: str) -> int | None:
    seconds, nanoseconds = text.split(",")
    if not seconds and not nanoseconds:
        return None
    ns = int(seconds or 0) * _NS_PER_S + int(nanoseconds or 0)
    return ns if 0 < ns < _INFINITE_NS else None
