# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface of the outside: endpoints that others have there, and those of the bridge."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from rmw_manycore_bridge.outside.loop import Loop, Mover
from rmw_manycore_py.native._transport import EndpointInfo, Node, Qos
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Direction, Route


@dataclass(frozen=True)
class Endpoint:
    """Publisher or subscription of another node; `type` names what does not fit, if it differs.

    Between hosts, the platform shows it: `node` is the full name of its node, `gid` what its
    messages have on the link, and `source` its gid on its platform.
    """

    type: str
    qos: Qos
    node: str = ""
    gid: bytes = b""
    source: bytes = b""


@dataclass(frozen=True)
class Answer:
    """Reply to the bridge's request; without data, the reason why there is none."""

    number: int
    data: bytes | None
    reason: str = ""


@dataclass(frozen=True)
class Joining:
    """How a process of the bridge joins a domain.

    :ivar name: name of its node there; those of the bridge's other processes have the same stem, up
        to the last underscore.
    :ivar changed: called after each change of the graph.
    :ivar is_own: whether a publisher with this gid is of this bridge.
    """

    plan: Plan
    direction: Direction
    domain: int
    name: str
    changed: Callable[[], None]
    is_own: Callable[[bytes], bool]


class Platform(Protocol):
    """Nodes of the platform, and the movers of its thread."""

    movers: list[Mover]

    def nodes(self) -> set[str]:
        """Return the full names of nodes, except the bridge's and hidden ones."""

    def stand_in(self, full_name: str) -> Node:
        """Return a node that stands for one of another host, for as long as it is referred to."""


class OutsideError(RuntimeError):
    """The engine refuses a call; the message names the reason."""


class Subscription(Protocol):
    """Takes serialized messages; the properties describe the message taken last."""

    @property
    def publisher(self) -> bytes:
        """Gid of the publisher."""

    @property
    def number(self) -> int:
        """Sequence number; rises by one with each message of the publisher."""

    @property
    def sent_ns(self) -> int:
        """Source timestamp, CLOCK_REALTIME."""

    @property
    def address(self) -> int:
        """Address, valid until the next message is taken."""

    @property
    def size(self) -> int:
        """Size in bytes."""

    def take(self) -> bool:
        """Take the next message; return whether there is one."""

    def matched(self) -> int:
        """Return the number of publishers that it is matched with."""

    def close(self) -> None:
        """Destroy it."""


class Publisher(Protocol):
    """Publishes serialized messages."""

    @property
    def gid(self) -> bytes:
        """What subscriptions know it by, 16 bytes."""

    def show(self, sources: Sequence[EndpointInfo]) -> None:
        """Show the platform's publishers outside, if the engine can."""

    def resume(self) -> None:
        """Go on after a time without subscriptions outside."""

    def publish(self, address: int, size: int, sent_ns: int, publisher: bytes, number: int) -> None:
        """Publish `size` bytes of a platform's publisher; the memory is free afterwards.

        :param number: of the message, by its publisher.
        """

    def has_listeners(self) -> bool:
        """Return whether others subscribe to the topic."""

    def matched(self) -> int:
        """Return the number of subscriptions that it is matched with."""

    def is_acknowledged(self) -> bool:
        """Return whether every reliable subscription has acknowledged everything."""

    def close(self) -> None:
        """Destroy it."""


class Server(Protocol):
    """Server of a service, for callers outside."""

    def take(self) -> tuple[Any, bytes] | None:
        """Take the next request: its caller, for `reply`, and its data."""

    def reply(self, caller: Any, data: bytes) -> None:
        """Send a response."""

    def close(self) -> None:
        """Destroy it."""


class Client(Protocol):
    """Client of a service that is outside."""

    def is_ready(self) -> bool:
        """Return whether a server is matched."""

    def send(self, data: bytes) -> int:
        """Send a request and return its number."""

    def take(self) -> Answer | None:
        """Take the next answer."""

    def close(self) -> None:
        """Destroy it."""


class Outside(Loop):
    """Thread of one domain outside.

    :ivar readers: called in this thread when their subscription, server or client has something.
    :cvar links_platforms: whether it joins parts of one platform, whose publishers keep their gids.
    """

    links_platforms = False

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.readers: dict[Any, Callable[[], None]] = {}

    @classmethod
    @abstractmethod
    def open(cls, joining: Joining) -> Outside:
        """Join a domain."""

    @classmethod
    @abstractmethod
    def prepare(cls, scratch: Path, replaces: bool) -> None:
        """Prepare this process before it joins a domain; print what will keep it from working.

        :param scratch: a file that this process may write; it is removed with the platform.
        :param replaces: whether it replaces a process that received, and has ended.
        """

    def show_nodes(self, platform: Platform) -> None:
        """Show nodes of each side on the other, beside their endpoints; by default, none."""

    @abstractmethod
    def require_type(self, name: str) -> None:
        """Raise ImportError unless the type can cross."""

    @abstractmethod
    def publishers(self, route: Route, is_wanted: bool) -> list[Endpoint]:
        """Return the publishers of a topic, except this bridge's.

        :param is_wanted: whether to search for publishers that the graph does not report, too.
        """

    @abstractmethod
    def published(self, wanted: Callable[[str], bool]) -> Mapping[str, frozenset[str]]:
        """Return the types published by others than this bridge, by topic name."""

    def served(self, wanted: Callable[[str], bool]) -> Mapping[str, frozenset[str]]:
        """Return the types of services served by others than this bridge, by name.

        Only between hosts are there patterns of services.
        """
        raise NotImplementedError

    @abstractmethod
    def server_types(self, service: str) -> list[str]:
        """Return the types of a service's servers, except this bridge's."""

    @abstractmethod
    def subscribe(self, route: Route, qos: Qos) -> Subscription:
        """Subscribe to a topic."""

    @abstractmethod
    def publish(self, route: Route, qos: Qos) -> Publisher:
        """Create a publisher."""

    @abstractmethod
    def serve(self, route: Route) -> Server:
        """Offer a service, on a node of the route's name if it has one."""

    @abstractmethod
    def call(self, route: Route) -> Client:
        """Create a client."""
