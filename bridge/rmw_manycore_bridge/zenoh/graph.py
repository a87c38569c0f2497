# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Graph of a domain: liveliness tokens of other nodes, and those of the bridge."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from functools import partial

import zenoh
from zenoh.handlers import Callback

from rmw_manycore_bridge.zenoh.keys import Kind, Token, TokenError, graph_key, parse_token

LINK_NODE = "/manycore_host_"  # the own nodes of links between hosts begin with it


class Declared:
    """Token of one of the bridge's endpoints, until it is withdrawn."""

    def __init__(self, token: Token, live: zenoh.LivelinessToken, node: StandIn) -> None:
        self.token, self._live, self._node = token, live, node

    def withdraw(self) -> None:
        """Take it out of the graph, and its node with the node's last endpoint."""
        self._live.undeclare()
        self._node.leave()


class StandIn:
    """Node of the bridge, which is in the graph while it has endpoints."""

    def __init__(self, number: int, live: zenoh.LivelinessToken, left: Callable[[], None]) -> None:
        self.number, self._live, self._left = number, live, left
        self._users = 0

    def enter(self) -> None:
        """Count one more endpoint."""
        self._users += 1

    def leave(self) -> None:
        """Count one endpoint less."""
        self._users -= 1
        if not self._users:
            self._live.undeclare()
            self._left()


class Graph:
    """All tokens of a domain. Callable from any thread; zenoh's threads change it."""

    def __init__(
        self,
        session: zenoh.Session,
        domain: int,
        node: str,
        changed: Callable[[], None],
    ) -> None:
        self._session, self._domain, self._node = session, domain, node
        self._zid = str(session.info.zid())
        self._changed = changed
        self._tokens: dict[str, Token] = {}
        self._said: set[str] = set()
        self._met: dict[str, set[str]] = {}  # nodes that routes have met with, by session
        self._numbers = itertools.count()
        self._nodes: dict[str, StandIn] = {}
        self._enter(f"/{node}").enter()  # the bridge's own node stays
        # In the thread that reads the link, so that a token is known before what follows it.
        noted = Callback(self._noted, indirect=False)
        self._watch = session.liveliness().declare_subscriber(
            graph_key(domain), noted, history=True
        )

    def endpoints(self, kind: Kind, name: str | None = None) -> list[Token]:
        """Return the endpoints of other nodes."""
        found = [
            token
            for token in list(self._tokens.values())
            if token.kind == kind and name in (None, token.name) and not self._is_own(token)
        ]
        for token in found if name is not None else ():
            self._met.setdefault(token.session, set()).add(token.full_node_name)
        return found

    def nodes(self) -> set[str]:
        """Return the full names of other nodes."""
        found = list(self._tokens.values())
        return {t.full_node_name for t in found if t.kind == "NN" and not self._is_own(t)}

    def show_node(self, full_name: str) -> StandIn:
        """Put a node into the graph until it is left."""
        found = self._enter(full_name)
        found.enter()
        return found

    def has_any(self, kind: Kind, name: str) -> bool:
        """Return whether there is an endpoint, also of the bridge."""
        return any((t.kind, t.name) == (kind, name) for t in list(self._tokens.values()))

    def forget(self, session: str) -> set[str]:
        """Return the nodes of a session that is gone, as far as routes have met with them."""
        return self._met.pop(session, set())

    def token(
        self,
        kind: Kind,
        full_node: str | None,
        name: str,
        type_name: str,
        type_hash: str,
        qos: str,
        source: bytes = b"",
    ) -> Token:
        """Return the token of a new endpoint, which enters the graph with its node, if it is named.

        Otherwise it is on the bridge's own node.
        """
        node = full_node or f"/{self._node}"
        namespace, _, short = node.rpartition("/")
        return Token(
            *(self._domain, self._zid, self._enter(node).number, next(self._numbers), kind),
            *(namespace or "/", short, name, type_name, type_hash, qos),
            source=source,
        )

    def declare(self, token: Token) -> Declared:
        """Put an endpoint into the graph."""
        live = self._session.liveliness().declare_token(token.text)
        return Declared(token, live, self.show_node(token.full_node_name))

    def _enter(self, full_name: str) -> StandIn:
        found = self._nodes.get(full_name)
        if found is None:
            number = next(self._numbers)
            namespace, _, short = full_name.rpartition("/")
            token = Token(self._domain, self._zid, number, number, "NN", namespace or "/", short)
            live = self._session.liveliness().declare_token(token.text)
            found = StandIn(number, live, partial(self._nodes.__delitem__, full_name))
            self._nodes[full_name] = found
        return found

    def _is_own(self, token: Token) -> bool:
        """Return whether a token is of this session, or of another process of this bridge."""
        stem = self._node.rpartition("_")[0]
        return token.session == self._zid or token.node.rpartition("_")[0] == stem

    def _noted(self, sample: zenoh.Sample) -> None:
        """Note a token that has come or gone, in a thread of zenoh."""
        text = str(sample.key_expr)
        if sample.kind == zenoh.SampleKind.DELETE:
            self._tokens.pop(text, None)
        else:
            try:
                token = self._tokens[text] = parse_token(text)
            except TokenError as error:
                self.report_once(f"unknown token in the graph: {error}", text)
                return
            if token.full_node_name.startswith(LINK_NODE):
                self._met.setdefault(token.session, set()).add(token.full_node_name)
        self._changed()

    def report_once(self, problem: str, example: str) -> None:
        """Print a problem when it first occurs."""
        if problem not in self._said:
            self._said.add(problem)
            report(f"{problem}: {example!a}")  # it may contain control characters

    def close(self) -> None:
        """Stop watching; the session withdraws all tokens."""
        self._watch.undeclare()


def report(text: str) -> None:
    """Print a line about the session."""
    print(f"zenoh: {text}", file=sys.stderr, flush=True)
