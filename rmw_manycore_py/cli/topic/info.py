# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic info`, printed as `ros2 topic info` prints."""

from __future__ import annotations

import click

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.options import examples, json_option, platform_option
from rmw_manycore_py.cli.common.printing import print_json
from rmw_manycore_py.cli.common.view import Row
from rmw_manycore_py.errors import ManycoreError


@click.command(
    "info",
    epilog=examples("manycore topic info /chatter", "manycore topic info /chatter --verbose"),
)
@click.argument("topic")
@click.option("-v", "--verbose", is_flag=True, help="Show each publisher and subscription.")
@json_option
@platform_option
def command(topic: str, platform: str, as_json: bool, verbose: bool) -> None:
    """Show who publishes TOPIC and who subscribes to it."""
    endpoints = view.endpoints_of_topic(view.open_platform(platform).endpoints(), topic)
    if not endpoints:
        raise ManycoreError(f"unknown topic '{topic}' (manycore topic list shows all)")
    publishers = [e for e in endpoints if e["kind"] == "publisher"]
    subscriptions = [e for e in endpoints if e["kind"] == "subscription"]
    if as_json:
        print_json({"topic": topic, "publishers": publishers, "subscriptions": subscriptions})
        return
    types = list(dict.fromkeys(e["type"] for e in endpoints))
    click.echo(f"Type: {types[0] if len(types) == 1 else types}")
    for title, rows in (("Publisher", publishers), ("Subscription", subscriptions)):
        if not verbose:
            click.echo(f"{title} count: {len(rows)}")
            continue
        click.echo(f"\n{title} count: {len(rows)}")
        for row in rows:
            click.echo(f"\n{describe(row)}")


def describe(endpoint: Row) -> str:
    """Return one endpoint as `ros2 topic info --verbose` does, and below it where it runs."""
    gid = endpoint["gid"]
    counters = ", ".join(f"{name} {count}" for name, count in endpoint["counters"].items())
    return "\n".join(
        (
            f"Node name: {endpoint['node']}",
            f"Node namespace: {endpoint['namespace']}",
            f"Topic type: {endpoint['type']}",
            f"Topic type hash: {endpoint['type_hash']}",
            f"Endpoint type: {endpoint['kind'].upper()}",
            f"GID: {'.'.join(gid[i : i + 2] for i in range(0, len(gid), 2))}",
            "QoS profile:",
            *(f"  {line}" for line in _describe_qos(endpoint["qos"])),
            f"Cluster: {endpoint['cluster']}",
            f"Matched: {endpoint['matched']}",
            f"Counters: {counters}",
        )
    )


def _describe_qos(qos: Row) -> list[str]:
    history = qos["history"].upper()
    return [
        f"Reliability: {qos['reliability'].upper()}",
        f"History (Depth): {history}" + (f" ({qos['depth']})" if history == "KEEP_LAST" else ""),
        f"Durability: {qos['durability'].upper()}",
        f"Lifespan: {_duration(qos['lifespan_ns'])}",
        f"Deadline: {_duration(qos['deadline_ns'])}",
        f"Liveliness: {qos['liveliness'].upper()}",
        f"Liveliness lease duration: {_duration(qos['liveliness_lease_ns'])}",
    ]


def _duration(duration_ns: int | None) -> str:
    return "Infinite" if duration_ns is None else f"{duration_ns} nanoseconds"
