# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore map show`."""

from __future__ import annotations

import shlex
from pathlib import Path

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import (
    echo,
    new_table,
    print_json,
    print_notices,
    print_table,
    size_text,
)
from rmw_manycore_py.mapfile import Placement, load_mapfile, resolve
from rmw_manycore_py.mapfile.placing.show import as_data, rules_in_words
from rmw_manycore_py.platform.topology import as_host_cpu, host_cpu_text
from rmw_manycore_py.routes.route import DIRECTIONS


@click.command("show", epilog=examples("manycore map show three_nodes"))
@mapfile_argument()
@json_option
def command(mapfile: Path, as_json: bool) -> None:
    """Show the placement of MAPFILE.

    Nodes, topic table, memory of the clusters.
    """
    placement = resolve(load_mapfile(mapfile), to_start=False)
    if as_json:
        print_json(as_data(placement))
        return
    print_notices(placement.notices)
    _show_nodes(placement)
    _show_rules(placement)
    _show_topics(placement)
    _show_memory(placement)


def _show_nodes(placement: Placement) -> None:
    echo(f"platform {placement.name} ({placement.topology.profile})")
    table = new_table("node", "#cluster", "#core", "#host CPU", "command")
    for node in placement.nodes:
        place = (str(node.cluster), str(node.core), str(node.host_cpu))
        table.add_row(node.full_name, *place, shlex.join(node.program) or node.missing)
        for core, cpu in node.workers:
            table.add_row("  worker", str(core.cluster), str(core.core), str(cpu), "")
    if placement.bridge:
        cpus = host_cpu_text(as_host_cpu(placement.bridge.host_cpus))
        for lane in placement.bridge.cores:
            for direction, core in zip(DIRECTIONS, lane, strict=True):
                table.add_row(f"(bridge {direction})", *map(str, core), cpus, "")
    print_table(table)


def _show_rules(placement: Placement) -> None:
    rules = {node.full_name: rules_in_words(node) for node in placement.nodes}
    if any(rules.values()):
        echo("\nlaunch rules")
        table = new_table("node", "rule")
        for name, words in rules.items():
            for word in words:
                table.add_row(name, word)
        print_table(table)


def _show_topics(placement: Placement) -> None:
    echo("\ntopic table")
    columns = (
        "#id",
        "topic",
        "type",
        "#topic DSM bytes",
        "transfer",
        "publishers in",
        "receivers in",
    )
    table = new_table(*columns)
    for topic in placement.topics:
        size = str(topic.topic_dsm_size or "grows")
        clusters = (topic.publisher_clusters, topic.receiver_clusters)
        places = (", ".join(map(str, numbers)) or "-" for numbers in clusters)
        row = (str(topic.id), topic.name, topic.type or "?", size, topic.transfer_text)
        table.add_row(*row, *places)
    print_table(table)


def _show_memory(placement: Placement) -> None:
    echo("\nmemory")
    table = new_table("#cluster", "#SMEM", "#fixed topic DSMs")
    for memory in placement.memory:
        table.add_row(str(memory.cluster), size_text(memory.smem_size), size_text(memory.used))
    print_table(table)
