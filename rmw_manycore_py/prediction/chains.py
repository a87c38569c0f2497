# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latency of the chains of a simulation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rmw_manycore_py.prediction.prediction import ChainTimes
from rmw_manycore_py.prediction.simulation import Simulation
from rmw_manycore_py.prediction.topics import Taken
from rmw_manycore_py.trace.chains import Arrival, CausedMessages, Chain
from rmw_manycore_py.trace.events import RecordId
from rmw_manycore_py.trace.latency import TOTAL, latencies

MAX_CHAINS = 200  # of an application with more, the first ones


def chain_times(simulation: Simulation, chains: Sequence[Chain] | None) -> Iterator[ChainTimes]:
    """Yield the latency of the chains with these topics; default: of all causal chains."""
    messages = messages_of(simulation)
    wanted = messages.chains[:MAX_CHAINS] if chains is None else chains
    for one in latencies(messages, wanted):
        (total,) = (part for part in one.parts if part.name == TOTAL)
        yield ChainTimes(one.name, total.samples_us)


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
