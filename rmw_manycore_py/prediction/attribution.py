# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which callbacks publish, where a profile names nodes only.

CARET's architecture often lists what a node publishes without the callback. Then the callback is
one whose rate is that of the topic's readers: of several, the one that works longest; of those that
work about as long, a subscription's. If none fits, it is the callback with the nearest rate.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from statistics import median

from rmw_manycore_py.profile.model import Callback, Output, Profile

_FITS = 0.01  # of a rate
_ABOUT_AS_LONG = 3.0


def attributed(profile: Profile) -> Profile:
    """Return the profile with a publishing callback for each topic that a callback reads."""
    found: dict[int, list[Output]] = defaultdict(list)
    for publisher, callback in _missing(profile):
        found[callback].append(Output(publisher=publisher, count=None, offset_ns=None))
    if not found:
        return profile
    callbacks = tuple(
        one.model_copy(update={"publishes": (*one.publishes, *found[index])})
        if index in found
        else one
        for index, one in enumerate(profile.callbacks)
    )
    return profile.model_copy(update={"callbacks": callbacks})


def rates_of_topics(profile: Profile) -> dict[str, float]:
    """Return the rate at which callbacks read each topic: the highest of them."""
    rates: dict[str, float] = {}
    for one in profile.callbacks:
        if one.kind == "subscription" and one.rate_hz:
            rates[one.trigger] = max(one.rate_hz, rates.get(one.trigger, 0.0))
    return rates


def heard_shares(profile: Profile) -> dict[str, float]:
    """Return which share of each topic's messages its median reader got.

    Messages published while an application starts reach few readers.
    """
    read: dict[str, list[float]] = defaultdict(list)
    for one in profile.callbacks:
        if one.kind == "subscription" and one.rate_hz:
            read[one.trigger].append(one.rate_hz)
    published: dict[str, int] = defaultdict(int)
    for publisher in profile.publishers:
        published[publisher.topic] += publisher.publications or 0
    span_s = (profile.duration_ns or 0) / 1e9
    return {
        topic: min(median(rates) * span_s / published[topic], 1.0)
        for topic, rates in read.items()
        if published[topic] and span_s
    }


def _missing(profile: Profile) -> Iterator[tuple[int, int]]:
    """Yield publishers without a callback, and the callbacks that they are of."""
    known = {output.publisher for one in profile.callbacks for output in one.publishes}
    of_node: dict[int, list[int]] = defaultdict(list)
    for index, one in enumerate(profile.callbacks):
        if one.node is not None and one.rate_hz and one.wall_ns:
            of_node[one.node].append(index)
    rates = rates_of_topics(profile)
    seen: set[tuple[int, str]] = set()
    for index, publisher in enumerate(profile.publishers):
        rate_hz = rates.get(publisher.topic)
        is_counted = publisher.publications is not None
        if index in known or is_counted or publisher.node is None or rate_hz is None:
            continue
        candidates = of_node.get(publisher.node, [])
        if candidates and (publisher.node, publisher.topic) not in seen:
            seen.add((publisher.node, publisher.topic))
            yield index, _chosen(profile, candidates, rate_hz)


def _chosen(profile: Profile, candidates: list[int], rate_hz: float) -> int:
    callbacks = profile.callbacks
    fitting = [
        i for i in candidates if abs((callbacks[i].rate_hz or 0) - rate_hz) <= _FITS * rate_hz
    ]
    if not fitting:
        return min(candidates, key=lambda i: abs((callbacks[i].rate_hz or 0) - rate_hz))
    longest = max(map(_mean_ns, (callbacks[i] for i in fitting)))
    working = [i for i in fitting if _mean_ns(callbacks[i]) * _ABOUT_AS_LONG >= longest]
    return max(working, key=lambda i: (callbacks[i].kind == "subscription", _mean_ns(callbacks[i])))


def _mean_ns(callback: Callback) -> float:
    return callback.wall_ns.mean if callback.wall_ns else 0.0
