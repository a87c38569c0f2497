# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A domain of rmw_zenoh as the outside of the bridge."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from threading import Event
from typing import Protocol

import zenoh

from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.interface import Endpoint, Joining, Outside
from rmw_manycore_bridge.zenoh import qos as qos_text
from rmw_manycore_bridge.zenoh.connections import Connections
from rmw_manycore_bridge.zenoh.graph import Declared, Graph
from rmw_manycore_bridge.zenoh.keys import Kind, Token, any_key, data_key
from rmw_manycore_bridge.zenoh.services import ZenohClient, ZenohServer
from rmw_manycore_bridge.zenoh.session import open_session
from rmw_manycore_bridge.zenoh.topics import ZenohPublisher, ZenohSubscription
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.routes.route import Route

_SHOWN_DIGITS = 19  # of a hash in a reason: RIHS01_ and 12 digits


class Watch(Protocol):
    """Watches a session until it is closed."""

    def close(self) -> None:
        """Watch no more."""


class Zenoh(Outside):
    """Thread that passes on what zenoh's own threads have received."""

    def __init__(self, joining: Joining) -> None:
        domain = joining.domain
        super().__init__(f"zenoh domain {domain}")
        self._domain, self._changed = domain, joining.changed
        self._session = self._open_session(joining)
        self._ready = Event()
        self._is_changed = False
        self._error: BaseException | None = None  # of a thread of zenoh
        # Subscriptions that search for publishers without tokens, by topic inside and outside.
        self._scouts: dict[tuple[str, str], ZenohSubscription] = {}
        self._graph = Graph(self._session, domain, joining.name, self._note_change)
        self._connections = self._watch(joining, self._graph)

    @classmethod
    def open(cls, joining: Joining) -> Zenoh:
        """Join a domain; without a router, it begins once there is one."""
        return cls(joining)

    def _open_session(self, joining: Joining) -> zenoh.Session:
        return open_session(joining.plan.outside.connect)

    def _watch(self, joining: Joining, graph: Graph) -> Watch:
        """Watch the session's connections."""
        return Connections(self._session, joining.plan.outside.connect, graph)

    @classmethod
    def prepare(cls, scratch: Path, replaces: bool) -> None:
        """Nothing: a session needs no preparation."""

    def require_type(self, name: str) -> None:
        """Raise ImportError unless the type's hash is known, which keys contain."""
        if not name or types.hash_of(name):
            return
        here, _, other = name.partition(" ")
        if other:  # see `_type_of`
            raise ImportError(f"is {name} outside, not {here}")
        package = name.partition("/")[0]
        raise ImportError(
            f"type {name} is not installed: there is no package '{package}' with its hash"
        )

    def publishers(self, route: Route, is_wanted: bool) -> list[Endpoint]:
        """Return the publishers of a topic; one without a token once it is heard."""
        scout = self._scouts.get(_name(route))
        if scout is not None and not scout.is_in_graph and not is_wanted:
            scout.close()
            scout = None
        if tokens := self._graph.endpoints("MP", route.outside):
            if scout is not None and scout.is_in_graph:
                del self._scouts[_name(route)]  # the tokens show when the publishers are gone
            return [Endpoint(self._type_of(token), self._qos_of(token)) for token in tokens]
        if scout is None and is_wanted:
            self._scouts[_name(route)] = self._scout(route)
        is_heard = scout is not None and (scout.is_in_graph or scout.has_data())
        return [Endpoint(route.type, Qos())] if is_heard else []

    def published(self, wanted: Callable[[str], bool]) -> Mapping[str, frozenset[str]]:
        """Return the types published by others than this bridge, by topic name."""
        return self._types("MP", wanted)

    def served(self, wanted: Callable[[str], bool]) -> Mapping[str, frozenset[str]]:
        """Return the types of services served by others than this bridge, by name."""
        return self._types("SS", wanted)

    def _types(self, kind: Kind, wanted: Callable[[str], bool]) -> Mapping[str, frozenset[str]]:
        found: dict[str, set[str]] = {}
        for token in self._graph.endpoints(kind):
            if wanted(token.name):
                found.setdefault(token.name, set()).add(self._type_of(token))
        return {name: frozenset(kinds) for name, kinds in found.items()}

    def server_types(self, service: str) -> list[str]:
        """Return the types of a service's servers, except this bridge's."""
        return [self._type_of(token) for token in self._graph.endpoints("SS", service)]

    def subscribe(self, route: Route, qos: Qos) -> ZenohSubscription:
        """Subscribe to a topic; go on with a scout, which has the first messages already."""
        made = self._scouts.get(_name(route))
        if made is not None and self._graph.endpoints("MP", route.outside):
            del self._scouts[_name(route)]  # as above
        if made is not None and qos.durability == "transient_local":
            made.close()  # it has no history
            made = None
        if made is None:
            made = ZenohSubscription(self._key(route), self._forward)
            made.keep(qos)
            made.declare(self._session, self._key(route), qos)
        else:
            made.keep(qos)
        made.appear(self._declared("MS", route, qos), self._forward)
        return made

    def publish(self, route: Route, qos: Qos) -> ZenohPublisher:
        """Create a publisher."""
        token = self._token("MP", route, qos)
        made = ZenohPublisher(self._graph, token, self._note_change)
        made.appear()
        made.declare(self._session, self._key(route), qos)
        return made

    def serve(self, route: Route) -> ZenohServer:
        """Offer a service, on a node of the route's name if it has one."""
        declared = self._declared("SS", route, Qos())
        return ZenohServer(self._session, self._key(route), declared, self._ready.set)

    def call(self, route: Route) -> ZenohClient:
        """Create a client."""
        declared = self._declared("SC", route, Qos())
        key, timeout_s = self._key(route), route.timeout_s
        return ZenohClient(self._session, key, self._graph, declared, timeout_s, self._ready.set)

    def wake(self) -> None:
        """Interrupt the current or next wait. Thread-safe."""
        self._ready.set()

    def turn(self, timeout_s: float | None) -> None:
        """Block until something changes, then forward what has arrived."""
        # A thread of zenoh that runs a mover may change the readers: iterate over a copy.
        if not any(reader.has_data() for reader in list(self.readers)):
            self._ready.wait(timeout_s)
        self._ready.clear()
        if self._error is not None:
            raise self._error
        if self._is_changed:
            self._is_changed = False
            self._changed()
        with self._moving:
            for reader, pump in list(self.readers.items()):
                if reader.has_data():
                    pump()

    def _forward(self, subscription: ZenohSubscription) -> None:
        """Forward messages in the thread of zenoh that received them; leave them if others run."""
        if not self._moving.acquire(blocking=False):
            self._ready.set()
            return
        try:
            pump = self.readers.get(subscription)
            if pump is not None and not self._stopping:
                pump()
        except BaseException as error:  # it ends the loop, as in the loop's own thread
            self._error = error
            self._ready.set()
        finally:
            self._moving.release()
        if subscription.has_data():
            self._ready.set()

    def close(self) -> None:
        """Leave the domain."""
        for scout in list(self._scouts.values()):
            scout.close()
        self._connections.close()
        self._graph.close()
        self._session.close()

    def _scout(self, route: Route) -> ZenohSubscription:
        """Return a subscription that searches for publishers without a token."""
        made = ZenohSubscription(
            *(
                self._key(route),
                lambda _: self._note_change(),
                partial(self._scouts.pop, _name(route), None),
            ),
        )
        made.declare(self._session, any_key(self._domain, route.outside), Qos())
        return made

    def _note_change(self) -> None:
        """Note a change of the graph, in a thread of zenoh."""
        self._is_changed = True
        self._ready.set()

    def _declared(self, kind: Kind, route: Route, qos: Qos) -> Declared:
        return self._graph.declare(self._token(kind, route, qos))

    def _token(self, kind: Kind, route: Route, qos: Qos) -> Token:
        type_hash = types.hash_of(route.type)
        return self._graph.token(
            *(kind, route.node, route.outside, route.type, type_hash, qos_text.encode(qos))
        )

    def _key(self, route: Route) -> str:
        return data_key(self._domain, route.outside, route.type, types.hash_of(route.type))

    def _type_of(self, token: Token) -> str:
        """Return a type, with its hash if that differs from the one here."""
        here = types.hash_of(token.type)
        if not here or token.type_hash == here:
            return token.type
        return f"{token.type} of another definition ({token.type_hash[:_SHOWN_DIGITS]}..)"

    def _qos_of(self, token: Token) -> Qos:
        try:
            return qos_text.decode(token.qos)
        except ValueError:
            self._graph.report_once("unknown QoS in the graph, taken as the default", token.text)
            return Qos()


def _name(route: Route) -> tuple[str, str]:
    return route.inside, route.outside
