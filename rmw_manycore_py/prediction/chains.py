# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latency of the chains of a simulation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from rmw_manycore_py.prediction.named import Passed, Published, Takes, named_chains
from rmw_manycore_py.prediction.prediction import ChainTimes
from rmw_manycore_py.prediction.simulation import Simulation
from rmw_manycore_py.prediction.topics import Subscription, Taken
from rmw_manycore_py.trace.chains import Arrival, CausedMessages, Chain
from rmw_manycore_py.trace.events import RecordId
from rmw_manycore_py.trace.latency import TOTAL, latencies

_NS_PER_US = 1000
MAX_CHAINS = 200  # of an application with more, the first ones


def chain_times(simulation: Simulation, chains: Sequence[Chain] | None) -> Iterator[ChainTimes]:
    """Yield the latency of these chains; default: of those with a name, else of all causal ones."""
    if chains is None and simulation.profile.chains:
        for name, latencies_ns in named_chains(simulation.profile, passed_in(simulation)):
            yield ChainTimes(name, tuple(one / _NS_PER_US for one in latencies_ns))
        return
    if chains is not None and not chains:
        return
    messages = messages_of(simulation)
    wanted = messages.chains[:MAX_CHAINS] if chains is None else chains
    for one in latencies(messages, wanted):
        (total,) = (part for part in one.parts if part.name == TOTAL)
        yield ChainTimes(one.name, total.samples_us)


def passed_in(simulation: Simulation) -> Passed:
    """Return the messages of a simulation; those whose callback has not ended are left out."""
    publishers = simulation.all_publishers
    return Passed(
        {
            one.endpoint: Published(np.array(one.times_ns), np.array(one.begins_ns))
            for one in publishers
        },
        {one.endpoint: one.node for one in publishers},
        {
            (subscription.node, subscription.topic): _takes(subscription)
            for work in simulation.works.values()
            if (subscription := work.subscription) is not None
        },
    )


def _takes(subscription: Subscription) -> Takes:
    ended = [one for one in subscription.taken if one.end_ns]
    return Takes(
        np.array([one.callback_ns for one in ended]),
        np.array([one.end_ns for one in ended]),
        np.array([one.message.publisher.endpoint for one in ended], np.int64),
        np.array([one.message.number for one in ended], np.int64),
    )


def messages_of(simulation: Simulation) -> CausedMessages:
    """Return the messages of a simulation, as a trace of it would have them."""
    messages = CausedMessages({one.endpoint: one.topic for one in simulation.all_publishers})
    arrivals: dict[int, Arrival] = {}
    for work in simulation.works.values():
        if work.subscription is None:
            continue
        for taken in work.subscription.taken:
            arrival = arrivals[id(taken)] = _arrival(taken)
            messages.arrivals[work.subscription.topic].append(arrival)
            messages.published_ns[arrival.record] = round(taken.message.published_ns)
    for work in simulation.works.values():
        if work.subscription is None:
            continue
        for taken in work.subscription.taken:
            cause = taken.message.cause
            if cause is not None and cause.subscription.node == taken.message.publisher.node:
                messages.causes[_record(taken)] = arrivals[id(cause)]
    messages.sort()
    return messages


def _arrival(taken: Taken) -> Arrival:
    return Arrival(_record(taken), taken.subscription.node, round(taken.callback_ns))


def _record(taken: Taken) -> RecordId:
    return taken.message.publisher.endpoint, taken.message.number
