# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The bridge's side of zenoh sessions, without a platform."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest

from rmw_manycore_bridge.outside.interface import Joining, OutsideError
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Route
from support import wait_until
from support.nodes.zenoh_peers import free_port, locator, session

pytestmark = [pytest.mark.unit, pytest.mark.needs("zenoh", "xxhash")]

CHAT = Route("topic", "inward", "/chat", "/chat", "std_msgs/msg/String", 7)
MESSAGE = b"\0\1\0\0\2\0\0\0a\0"


@pytest.fixture
def zenoh() -> Iterator[Any]:
    """Return a function that joins a domain, in which all are connected to the first."""
    from zenoh import ZError

    from rmw_manycore_bridge.zenoh.outside import Zenoh

    port = free_port()
    hub = session("router", listen__endpoints=[locator(port)])
    joined: list[Zenoh] = []

    def join(name: str) -> Zenoh:
        plan = Plan("", (CHAT,), OutsideSettings("zenoh", (locator(port),)))
        joining = Joining(plan, "inward", 7, name, lambda: None, lambda _: False)
        joined.append(Zenoh.open(joining))
        return joined[-1]

    yield join
    for one in joined:
        with suppress(ZError):  # closed by the test
            one.close()
    hub.close()


def publish(publisher: Any) -> None:
    buffer = ctypes.create_string_buffer(MESSAGE, len(MESSAGE))
    publisher.publish(ctypes.addressof(buffer), len(MESSAGE), 1, bytes(16), 1)


def test_a_message_that_zenoh_refuses_is_an_error_of_the_outside(zenoh) -> None:
    """The route counts it; another exception would end the process."""
    outside = zenoh("a_outward")
    publisher = outside.publish(CHAT, Qos())
    publish(publisher)
    outside.close()
    with pytest.raises(OutsideError, match="closed"):
        publish(publisher)


@pytest.mark.parametrize("durability", ["volatile", "transient_local"])
@pytest.mark.parametrize("reliability", ["reliable", "best_effort"])
def test_messages_that_came_while_no_route_took_them(zenoh, reliability, durability) -> None:
    """A route that pauses for a move to another lane, and goes on."""
    here, there = zenoh("a_inward"), zenoh("b_outward")
    qos = Qos(reliability=reliability, durability=durability)
    subscription, publisher = here.subscribe(CHAT, qos), there.publish(CHAT, qos)
    wait_until(publisher.has_listeners, "they are matched")
    publish(publisher)
    wait_until(subscription.has_data, "it has come")
    here.wake()
    here.turn(None)  # it has no subscription
    taken = threading.Event()

    def pump() -> None:
        assert subscription.take()
        taken.set()

    here.readers[subscription] = pump
    turn = threading.Thread(target=here.turn, args=(None,), daemon=True)
    turn.start()
    wait_until(taken.is_set, "it is forwarded without another event")
    turn.join()
