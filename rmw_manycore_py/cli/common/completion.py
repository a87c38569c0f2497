# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shell completion of names on the platform, types and mapfiles.

click calls these completers with the preceding words parsed as far as possible. They never join the
platform and never fail: a shell would print the error into the command line.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import click
from click.shell_completion import CompletionItem

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.interface_types import types_of_kind
from rmw_manycore_py.cli.common.rows import Row
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.runs.directory import runs_of
from rmw_manycore_py.native._transport import EndpointInfo
from rmw_manycore_py.ros import ament
from rmw_manycore_py.ros.domain import default_platform

Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem[str]]]
_Names = Callable[[click.Context], Iterable[str]]
_Rows = Callable[[Iterable[EndpointInfo]], Iterable[Row]]


def completer(names: _Names) -> Completer:
    """Return a completer that offers names with the typed prefix, or nothing on any error."""

    def complete(
        context: click.Context, _parameter: click.Parameter, incomplete: str
    ) -> list[CompletionItem[str]]:
        try:
            known = sorted(set(names(context)))
        except ManycoreError:
            known = []
        return [CompletionItem(name) for name in known if name.startswith(incomplete)]

    return complete


def platform_of(context: click.Context) -> str:
    """Return the platform given by the preceding words, or the default."""
    return context.params.get("platform") or default_platform()


def _endpoints(context: click.Context) -> list[EndpointInfo]:
    return view.endpoints_on(platform_of(context))


def _is_hidden_wanted(context: click.Context) -> bool:
    return bool(context.params.get("hidden"))


def _topics(context: click.Context) -> Iterator[str]:
    hidden = _is_hidden_wanted(context)
    return (row["name"] for row in view.topics(_endpoints(context), hidden=hidden))


def _services(context: click.Context) -> Iterator[str]:
    hidden = _is_hidden_wanted(context)
    return (row["name"] for row in view.services(_endpoints(context), hidden=hidden))


def _actions(context: click.Context) -> Iterator[str]:
    return (row["name"] for row in view.actions(_endpoints(context)))


def _nodes(context: click.Context) -> list[str]:
    with view.open_platform(platform_of(context)) as opened:
        return view.node_names(opened.nodes(), hidden=_is_hidden_wanted(context))


def _nodes_of_runs(context: click.Context) -> Iterator[str]:
    runs = runs_of(platform_of(context))
    return (node for run in runs if run.is_alive for node in run.nodes if node[0] != "(")


def _used_types(rows: _Rows, argument: str, kind: str) -> _Names:
    """Return a function that lists the types of the named topic or service, else all of a kind."""

    def names(context: click.Context) -> Iterable[str]:
        try:
            found = [r for r in rows(_endpoints(context)) if r["name"] == context.params[argument]]
        except ManycoreError:
            found = []
        return found[0]["types"] if found else types_of_kind(kind)

    return names


complete_platforms = completer(lambda _context: view.platform_names())
complete_nodes = completer(_nodes)
complete_nodes_of_runs = completer(_nodes_of_runs)
complete_topics = completer(_topics)
complete_services = completer(_services)
complete_actions = completer(_actions)
complete_message_types = completer(lambda _context: types_of_kind("msg"))
complete_service_types = completer(lambda _context: types_of_kind("srv"))
complete_types_of_topic = completer(
    _used_types(lambda endpoints: view.topics(endpoints, hidden=True), "topic", "msg")
)
complete_types_of_service = completer(
    _used_types(lambda endpoints: view.services(endpoints, hidden=True), "service", "srv")
)
complete_types_of_action = completer(_used_types(view.actions, "action", "action"))
complete_packages = completer(lambda _context: ament.packages_with_interfaces())
complete_types = completer(
    lambda _context: (
        name for package in ament.packages_with_interfaces() for name in ament.interfaces(package)
    )
)
