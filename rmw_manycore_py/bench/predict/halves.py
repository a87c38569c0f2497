# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One part of a run predicts another: from publications to the begins of callbacks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from statistics import median

from rmw_manycore_py.bench.predict.reports import UNSHARED
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.prediction import Sites, predict
from rmw_manycore_py.profile.model import Callback, Distribution, Profile

_Medians = dict[tuple[str, str], float]  # by node and topic

MIN_MESSAGES = 50  # in the profile that is predicted
# The profile's times before a callback have all of it: publish, transport, and waking.
_TARGET = UNSHARED.changed(
    dict.fromkeys(("wake_us", "wake_busy_us", "publish_us", "switch_us"), 0.0), "chosen"
)


@dataclass(frozen=True)
class PartErrors:
    """Median errors over subscriptions that are in both profiles.

    :ivar repeated: error of taking the first profile's median as it is.
    """

    subscriptions: int
    only_in_second: int
    error: float
    repeated: float


@dataclass(frozen=True)
class Parts:
    """How well one part predicts the other.

    :ivar queueing: of times from the call of publish to the begin of the callback.
    :ivar chains: from the first publication of the chain, for subscriptions most of whose messages
        were published in callbacks of others; None if there are none.
    """

    queueing: PartErrors
    chains: PartErrors | None


def parts_of(first: Profile, second: Profile, duration_s: float, seed: int) -> Parts:
    """Predict the second profile from the first.

    :raises ManycoreError: if they have no subscription with enough messages in common.
    """
    found = predict(Sites({}), first, _TARGET, seed=seed, duration_s=duration_s, chains=())
    queueing = _errors(
        {(one.node, one.topic): one.p50_us for one in found.communications},
        _queueing_us(first, 1),
        _queueing_us(second, MIN_MESSAGES),
    )
    chains = _errors(
        {(one.node, one.topic): one.age_us for one in found.communications},
        _ages_us(first, 1),
        _ages_us(second, MIN_MESSAGES),
    )
    if queueing is None:
        text = "the profiles have no subscription in common with times from publish to callback"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    return Parts(queueing, chains)


def _errors(predicted: _Medians, before: _Medians, measured: _Medians) -> PartErrors | None:
    common = [key for key in measured if key in predicted and key in before]
    if not common:
        return None
    return PartErrors(
        len(common),
        len(measured) - len(common),
        median(abs(predicted[key] / measured[key] - 1) for key in common),
        median(abs(before[key] / measured[key] - 1) for key in common),
    )


def _medians_us(
    profile: Profile, what: Callable[[Callback], Distribution | None], min_messages: int
) -> _Medians:
    """Return medians of a distribution that callbacks have."""
    middle = profile.quantile_shares.index(0.5)
    return {
        (profile.nodes[one.node].name, one.trigger): times_ns.quantiles[middle] / 1e3
        for one in profile.callbacks
        if one.node is not None
        and (times_ns := what(one)) is not None
        and (times_ns.count or 0) >= min_messages
    }


def _queueing_us(profile: Profile, min_messages: int) -> _Medians:
    return _medians_us(profile, lambda one: one.queued_ns, min_messages)


def _ages_us(profile: Profile, min_messages: int) -> _Medians:
    """Return the median ages of messages that came through other callbacks."""
    queueing_us = _queueing_us(profile, min_messages)
    ages_us = _medians_us(profile, lambda one: one.age_ns, min_messages)
    return {key: age_us for key, age_us in ages_us.items() if age_us > queueing_us[key]}
