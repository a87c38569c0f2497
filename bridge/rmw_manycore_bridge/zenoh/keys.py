# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Key expressions of rmw_zenoh: data keys, and liveliness tokens that make up the graph."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, get_args

import xxhash

GRAPH = "@ros2_lv"
# Node, publisher, subscription (of messages), server, client (of a service).
Kind = Literal["NN", "MP", "MS", "SS", "SC"]
_SLASH = "%"
_TYPE = re.compile(r"[a-z]\w*::(msg|srv|action)::dds_::[A-Z]\w*_", re.ASCII)
_NODE_PARTS, _ENDPOINT_PARTS = 9, 13  # newer releases may append more
_GID = re.compile(r"[0-9a-f]{32}")  # between hosts, the part behind those


class TokenError(ValueError):
    """A token is in no known format; the message names the reason."""


def dds_type(name: str) -> str:
    """Return the name of a type in keys.

    >>> dds_type("std_msgs/msg/String")
    'std_msgs::msg::dds_::String_'
    """
    package, kind, type_name = name.split("/")
    return f"{package}::{kind}::dds_::{type_name}_"


def ros_type(name: str) -> str:
    """Return a type by its name in keys.

    >>> ros_type("test_msgs::action::dds_::Fibonacci_SendGoal_")
    'test_msgs/action/Fibonacci_SendGoal'
    """
    return name.removesuffix("_").replace("dds_::", "").replace("::", "/")


def data_key(domain: int, name: str, type_name: str, type_hash: str) -> str:
    """Return the key of a topic's messages, or of a service's requests."""
    return f"{domain}/{name.strip('/')}/{dds_type(type_name)}/{type_hash}"


def any_key(domain: int, name: str) -> str:
    """Return the key expression of a name with any type and hash."""
    return f"{domain}/{name.strip('/')}/*/*"


def graph_key(domain: int) -> str:
    """Return the key expression of all tokens of a domain."""
    return f"{GRAPH}/{domain}/**"


@dataclass(frozen=True)
class Token:
    """Node or endpoint as its liveliness token describes it; of a node, `name` is empty.

    :ivar source: between hosts, gid of the publisher on its platform.
    """

    domain: int
    session: str
    node_id: int
    entity_id: int
    kind: Kind
    namespace: str
    node: str
    name: str = ""
    type: str = ""
    type_hash: str = ""
    qos: str = ""
    enclave: str = "/"
    source: bytes = b""

    @property
    def text(self) -> str:
        """Key expression."""
        identity = (self.domain, self.session, self.node_id, self.entity_id, self.kind)
        names = [mangled(part) for part in (self.enclave, self.namespace, self.node)]
        parts = [GRAPH, *map(str, identity), *names]
        if self.kind != "NN":
            parts += [mangled(self.name), dds_type(self.type), self.type_hash, self.qos]
        if self.source:
            parts.append(self.source.hex())
        return "/".join(parts)

    @property
    def gid(self) -> bytes:
        """Gid that rmw_zenoh derives from the key expression: XXH3-128, little-endian."""
        return int(xxhash.xxh3_128_intdigest(self.text.encode())).to_bytes(16, "little")

    @property
    def full_node_name(self) -> str:
        """Return /namespace/name of the node."""
        return f"{self.namespace.rstrip('/')}/{self.node}"


def parse_token(text: str) -> Token:
    """Return a token by its key expression; ignore unknown parts behind those that are known.

    :raises TokenError: if it has another format.
    """
    parts = text.split("/")
    if len(parts) < _NODE_PARTS or parts[0] != GRAPH:
        raise TokenError(f"expected {GRAPH} and at least {_NODE_PARTS - 1} parts more")
    kind = next((known for known in get_args(Kind) if known == parts[5]), None)
    if kind is None:
        raise TokenError(f"expected one of {', '.join(get_args(Kind))} as the 6th part")
    if kind != "NN" and len(parts) < _ENDPOINT_PARTS:
        raise TokenError(f"expected at least {_ENDPOINT_PARTS} parts, found {len(parts)}")
    enclave, namespace, node = map(demangled, parts[6:9])
    name = type_name = type_hash = qos = ""
    if kind != "NN":
        name, type_name, type_hash, qos = parts[9:13]
        if not _TYPE.fullmatch(type_name):
            raise TokenError("expected a type such as std_msgs::msg::dds_::String_")
    try:
        numbers = int(parts[1]), int(parts[3]), int(parts[4])
    except ValueError as error:
        raise TokenError("expected numbers of domain, node and entity") from error
    domain, node_id, entity_id = numbers
    source = next((part for part in parts[_ENDPOINT_PARTS:] if _GID.fullmatch(part)), "")
    return Token(
        *(domain, parts[2], node_id, entity_id, kind, namespace or "/", node),
        *(demangled(name), ros_type(type_name), type_hash, qos, enclave),
        bytes.fromhex(source),
    )


def mangled(name: str) -> str:
    """Return a name as one part of a key: slashes are replaced, and an empty one is a slash."""
    return name.replace("/", _SLASH) or _SLASH


def demangled(part: str) -> str:
    """Return the name of a part."""
    return part.replace(_SLASH, "/")
