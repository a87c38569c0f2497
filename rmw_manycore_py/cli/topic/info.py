# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic info`, with the output format of `ros2 topic info`."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_topics
from rmw_manycore_py.cli.common.names import unknown
from rmw_manycore_py.cli.common.options import examples, graph_options
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json, size_text
from rmw_manycore_py.cli.common.rows import copies_of, counters_row, endpoint_row
from rmw_manycore_py.native._transport import EndpointInfo, Qos


@click.command(
    "info",
    epilog=examples("manycore topic info /chatter", "manycore topic info /chatter --verbose"),
)
@click.argument("topic", shell_complete=complete_topics)
@click.option("-v", "--verbose", is_flag=True, help="Show each publisher and subscription.")
@graph_options
def command(topic: str, platform: str, as_json: bool, verbose: bool) -> None:
    """Show the publishers and subscriptions of TOPIC."""
    on_platform = view.endpoints_on(platform)
    endpoints = view.endpoints_of_topic(on_platform, topic)
    if not endpoints:
        raise unknown(topic, "topic", view.topics(on_platform, hidden=True))
    publishers = [e for e in endpoints if e.kind == "publisher"]
    subscriptions = [e for e in endpoints if e.kind == "subscription"]
    if as_json:
        kinds = {"publishers": publishers, "subscriptions": subscriptions}
        rows = {kind: [endpoint_row(e) for e in found] for kind, found in kinds.items()}
        print_json({"topic": topic, **rows})
        return
    types = list(dict.fromkeys(e.type for e in endpoints))
    echo(escaped(f"Type: {types[0] if len(types) == 1 else types}"))
    for title, found in (("Publisher", publishers), ("Subscription", subscriptions)):
        if not verbose:
            echo(f"{title} count: {len(found)}")
            continue
        echo(f"\n{title} count: {len(found)}")
        for endpoint in found:
            echo(f"\n{describe(endpoint)}")
    if verbose:
        echo()  # trailing blank line of ros2cli


def describe(endpoint: EndpointInfo) -> str:
    """Format an endpoint as `ros2 topic info --verbose` does, followed by its placement."""
    counters, copies = counters_row(endpoint.counters), copies_of(endpoint.counters)
    lines = (
        f"Node name: {endpoint.node_name}",
        f"Node namespace: {endpoint.node_namespace}",
        f"Topic type: {endpoint.type}",
        f"Topic type hash: {endpoint.type_hash}",
        f"Endpoint type: {endpoint.kind.upper()}",
        f"GID: {endpoint.gid.hex('.')}",
        "QoS profile:",
        *(f"  {line}" for line in _describe_qos(endpoint.qos)),
        f"Cluster: {endpoint.cluster}",
        *([f"Transfer: {endpoint.transfer}"] if endpoint.transfer != "dsm" else []),
        f"Matched: {endpoint.matched}",
        f"Counters: {', '.join(f'{name} {count}' for name, count in counters.items())}",
        *([] if copies is None else [f"Copies per message: {copies:.2g}"]),
        *([f"Held: {size_text(endpoint.held_bytes)}"] if endpoint.held_bytes else []),
    )
    return "\n".join(map(escaped, lines))


def _describe_qos(qos: Qos) -> list[str]:
    history = qos.history.upper()
    return [
        f"Reliability: {qos.reliability.upper()}",
        f"History (Depth): {history}" + (f" ({qos.depth})" if history == "KEEP_LAST" else ""),
        f"Durability: {qos.durability.upper()}",
        f"Lifespan: {_duration(qos.lifespan_ns)}",
        f"Deadline: {_duration(qos.deadline_ns)}",
        f"Liveliness: {qos.liveliness.upper()}",
        f"Liveliness lease duration: {_duration(qos.liveliness_lease_ns)}",
    ]


def _duration(duration_ns: int | None) -> str:
    return "Infinite" if duration_ns is None else f"{duration_ns} nanoseconds"
