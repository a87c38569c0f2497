# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Loads a bridge file, in the YAML schema of ros2/domain_bridge, as routes of a platform.

The platform's own domain ID (`inside`) stands for the platform; the others are domains outside.
Services, actions, rate and size limits, topic patterns, and `outside` extend that schema.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, StrictBool, ValidationError, field_validator, model_validator

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.document import Document, read_yaml
from rmw_manycore_py.mapfile.format.model import (
    Domain,
    OutsideSection,
    QosSection,
    Rate,
    Section,
    Text,
    Timeout,
    TopicName,
    TopicPattern,
)
from rmw_manycore_py.mapfile.format.validation import describe
from rmw_manycore_py.mapfile.format.values import ActionType, MessageType, ServiceType, Size
from rmw_manycore_py.mapfile.placing.crossings import overrides
from rmw_manycore_py.ros.names import expand
from rmw_manycore_py.ros.patterns import is_pattern
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import (
    REQUEST_TIMEOUT_S,
    Direction,
    Route,
    action_routes,
    arranged,
)

_KINDS = ("topics", "services", "actions")


class Crossing(Section):
    """Common part of topics, services and actions; a server is in `from_domain`."""

    from_domain: Domain | None = None
    to_domain: Domain | None = None
    remap: TopicName | None = None

    @field_validator("remap", mode="before")
    @classmethod
    def _no_name(cls, value: Any) -> Any:
        """Treat an empty `remap` as unset."""
        return None if value == "" else value


class TopicCrossing(Crossing):
    """A topic published in `from_domain`, or a pattern for topics of any type."""

    type: MessageType | None = None
    qos: QosSection = QosSection()
    bidirectional: StrictBool = False
    reversed: StrictBool = False
    max_hz: Rate | None = None
    max_size: Size | None = None

    @model_validator(mode="before")
    @classmethod
    def _no_settings(cls, value: Any) -> Any:
        """Treat an empty entry as one without settings: a pattern needs none."""
        return {} if value is None else value


class ServiceCrossing(Crossing):
    """A service entry."""

    type: ServiceType
    timeout: Timeout = REQUEST_TIMEOUT_S


class ActionCrossing(Crossing):
    """An action entry."""

    type: ActionType
    timeout: Timeout = REQUEST_TIMEOUT_S


class BridgeFile(Section):
    """A whole file. Names may occur more than once."""

    name: Text | None = None
    mode: Literal["normal"] = "normal"
    outside: OutsideSection = OutsideSection()
    from_domain: Domain | None = None
    to_domain: Domain | None = None
    topics: tuple[tuple[TopicPattern, TopicCrossing], ...] = Field(default=())
    services: tuple[tuple[TopicName, ServiceCrossing], ...] = Field(default=())
    actions: tuple[tuple[TopicName, ActionCrossing], ...] = Field(default=())


def load_bridge_file(
    path: Path, inside: int, note: Callable[[str], None] = lambda _: None
) -> tuple[Route, ...]:
    """Return the routes of a bridge file; see `load_plan`."""
    return load_plan(path, "", inside, note).routes


def load_plan(path: Path, platform: str, inside: int, note: Callable[[str], None]) -> Plan:
    """Read and validate a bridge file for the platform whose domain is `inside`.

    Entries between two other domains are skipped and reported through `note`; if the file has no
    other entries, that is an error.

    :raises MapfileError: for an invalid file.
    """
    document = read_yaml(path, repeated=_KINDS)
    if not isinstance(document.data, dict):
        raise MapfileError(document.problem((), "a mapping", describe(document.data)))
    try:
        sections = BridgeFile.model_validate(document.data)
    except ValidationError as error:
        problems = [_problem(document, dict(details)) for details in error.errors()]
    else:
        routes = _Resolver(document, sections, inside, note).routes()
        return Plan(platform, routes, sections.outside.settings)
    raise MapfileError(*problems)


def _problem(document: Document, details: dict[str, Any]) -> Problem:
    path = tuple(details["loc"])
    if details["type"] == "missing":
        return _named(document, path, f"the key '{path[-1]}'", "no such key")
    if details["type"] == "extra_forbidden":
        return _named(document, path, "a key of domain_bridge's schema", f"'{path[-1]}'")
    if details["type"] == "tuple_type":
        return _named(document, path, "a name and its settings: a mapping, no list", "a list")
    return _named(document, path, details["msg"].lower(), describe(details["input"]))


def _named(document: Document, path: tuple[Any, ...], expected: str, found: str) -> Problem:
    """Return a problem whose key shows the topic's name instead of its index."""
    shown = list(path)
    if len(path) > 1 and path[0] in _KINDS and isinstance(path[1], int):
        entry = document.data[path[0]][path[1]]
        shown[1:3] = [entry[0]] if isinstance(entry, tuple) else []
    key = ".".join(map(str, shown))
    return Problem(document.file, document.line(path), key, expected, found)


class _Resolver:
    """Resolves the domains of each entry, and on which side the platform is."""

    def __init__(
        self, document: Document, sections: BridgeFile, inside: int, note: Callable[[str], None]
    ) -> None:
        self._document, self._sections, self._inside = document, sections, inside
        self._note = note
        self._problems: list[Problem] = []
        self._foreign: list[Problem] = []

    def routes(self) -> tuple[Route, ...]:
        """Return all routes; raise one error for all entries with wrong domains."""
        found = [*self._topics(), *self._servers("services"), *self._servers("actions")]
        if not found:
            self._problems += self._foreign
        if not found and not self._problems:
            expected = "something to bridge in topics, services or actions"
            self._problems.append(self._document.problem((), expected, "nothing"))
        if self._problems:
            raise MapfileError(*self._problems)
        for problem in self._foreign:
            self._note(f"{problem}; skipped")
        return arranged(found, 1)

    def _topics(self) -> Iterator[Route]:
        for index, (name, topic) in enumerate(self._sections.topics):
            domains = self._domains("topics", index, topic)
            if domains is None or not self._is_whole(index, name, topic):
                continue
            source, target = reversed(domains) if topic.reversed else domains
            yield self._topic(name, topic, source, target)
            if topic.bidirectional:
                yield self._topic(name, topic, target, source)

    def _is_whole(self, index: int, name: str, topic: TopicCrossing) -> bool:
        """Check that a topic has a type, and that a pattern has no settings of a single topic."""
        if not is_pattern(name) and topic.type is None:
            self._wrong("topics", index, "the key 'type'", "no such key", "type")
        elif is_pattern(name) and topic.type is not None:
            expected = "no type: each topic that fits has its own"
            self._wrong("topics", index, expected, f"'{topic.type}'", "type")
        elif is_pattern(name) and topic.remap is not None:
            expected = "no new name: topics of a pattern keep theirs"
            self._wrong("topics", index, expected, f"'{topic.remap}'", "remap")
        else:
            return True
        return False

    def _topic(self, name: str, topic: TopicCrossing, source: int, target: int) -> Route:
        direction: Direction = "outward" if source == self._inside else "inward"
        names = expand(name, "/"), expand(topic.remap or name, "/")
        return Route(
            kind="topic",
            direction=direction,
            inside=names[0] if direction == "outward" else names[1],
            outside=names[1] if direction == "outward" else names[0],
            type=topic.type or "",
            domain=target if direction == "outward" else source,
            qos=overrides(topic.qos),
            max_hz=topic.max_hz,
            max_size=topic.max_size,
        )

    def _servers(self, kind: Literal["services", "actions"]) -> Iterator[Route]:
        for index, (name, service) in enumerate(getattr(self._sections, kind)):
            domains = self._domains(kind, index, service)
            if domains is None:
                continue
            server, client = domains
            inward = server == self._inside
            names = expand(name, "/"), expand(service.remap or name, "/")
            route = Route(
                kind="service",
                direction="inward" if inward else "outward",
                inside=names[0] if inward else names[1],
                outside=names[1] if inward else names[0],
                type=service.type,
                domain=client if inward else server,
                timeout_s=service.timeout,
            )
            yield from action_routes(route) if kind == "actions" else (route,)

    def _domains(self, kind: str, index: int, crossing: Crossing) -> tuple[int, int] | None:
        """Return (from, to); report domains that are missing, equal, or not of the platform."""
        pair = [
            own if own is not None else default
            for own, default in (
                (crossing.from_domain, self._sections.from_domain),
                (crossing.to_domain, self._sections.to_domain),
            )
        ]
        source, target = pair
        if source is None or target is None:
            key = "from_domain" if source is None else "to_domain"
            self._wrong(kind, index, f"the key '{key}' here or at the top", "no such key")
            return None
        if source == target:
            self._wrong(kind, index, "two different domains", f"{source} on both sides")
            return None
        if self._inside not in (source, target):
            expected = f"{self._inside}, the platform's domain (--inside), on one side"
            problem = _named(self._document, (kind, index, 1), expected, f"{source} and {target}")
            self._foreign.append(problem)
            return None
        return source, target

    def _wrong(self, kind: str, index: int, expected: str, found: str, *key: str) -> None:
        self._problems.append(_named(self._document, (kind, index, 1, *key), expected, found))
