# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore map show`."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import click

from rmw_manycore_py.advice.warnings import warnings_of
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option, rates_option
from rmw_manycore_py.cli.common.printing import (
    counted,
    echo,
    new_table,
    print_json,
    print_notices,
    print_table,
    size_text,
)
from rmw_manycore_py.cli.common.rates import load_rates
from rmw_manycore_py.cli.map.drawing import drawing_of
from rmw_manycore_py.mapfile import Placement, load_mapfile, resolve
from rmw_manycore_py.mapfile.mapping import Facts, facts_of
from rmw_manycore_py.mapfile.mapping.rates import TracedFacts
from rmw_manycore_py.mapfile.mapping.verdict import as_data as facts_as_data
from rmw_manycore_py.mapfile.mapping.verdict import verdict
from rmw_manycore_py.mapfile.placing.show import as_data, rules_in_words
from rmw_manycore_py.mapfile.programs.executables import command_text
from rmw_manycore_py.platform.topology import as_host_cpu, host_cpu_text
from rmw_manycore_py.profile.files import load
from rmw_manycore_py.routes.route import DIRECTIONS


@click.command(
    "show",
    epilog=examples(
        "manycore map show three_nodes",
        "manycore map show three_nodes --trace trace.json",
        "manycore map show map.yaml --profile app.profile.json",
    ),
)
@mapfile_argument()
@rates_option
@click.option(
    "--profile",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Warn about problems that this profile reveals.",
)
@json_option
def command(mapfile: Path, trace: Path | None, profile: Path | None, as_json: bool) -> None:
    """Show the placement of MAPFILE.

    Nodes, topic table, what crosses clusters, memory when the nodes have started; with a trace,
    rates and loads; with a profile, warnings.
    """
    loaded = load_mapfile(mapfile)
    placement = resolve(loaded, to_start=False)
    facts = facts_of(placement, load_rates(trace) if trace else None)
    warnings = [*warnings_of(loaded, placement, load(profile))] if profile else []
    if as_json:
        found = {**as_data(placement), "mapping": facts_as_data(facts), "warnings": warnings}
        print_json(found)
        return
    print_notices([*placement.notices, *warnings])
    _show_nodes(placement)
    if placement.topology.is_machine:
        echo("")
        for line in drawing_of(placement):
            echo(line)
    _show_rules(placement)
    _show_topics(placement)
    _show_crossings(facts)
    _show_memory(facts)
    if facts.traced:
        _show_loads(facts.traced)
    echo(f"\nverdict: {verdict(facts)}")


def _show_nodes(placement: Placement) -> None:
    echo(f"platform {placement.name} ({placement.topology.profile})")
    columns = ("node", "#cluster", "#core", "#host CPU", "command")
    table = new_table(*columns, expendable=("host CPU",))
    for node in placement.nodes:
        place = (str(node.cluster), str(node.core), str(node.host_cpu))
        table.add_row(node.full_name, *place, command_text(node.program) or node.missing)
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


def _show_crossings(facts: Facts) -> None:
    if not facts.crossings:
        return
    echo("\nbetween clusters")
    rates = ("#messages/s", "#bytes/s") if facts.traced else ()
    table = new_table("topic", "#from", "#to", *rates)
    for one in facts.crossings:
        row = [one.topic, str(one.publisher_cluster), str(one.receiver_cluster)]
        if facts.traced:
            messages, size_bytes = facts.per_s(one.messages), facts.per_s(one.size_bytes)
            row += [f"{messages or 0:.1f}", size_text(round(size_bytes or 0))]
        table.add_row(*row)
    print_table(table)


def _show_memory(facts: Facts) -> None:
    echo("\nmemory")
    peaks = facts.traced.peak_smem_bytes if facts.traced else {}
    columns = ("#cluster", "#SMEM", "#fixed topic DSMs", "#nodes", "#queues", "#total")
    table = new_table(*columns, *(("#most in the trace",) if peaks else ()))
    for memory in facts.memory:
        sizes = [memory.smem_size, memory.used, memory.nodes, memory.queues, memory.total]
        sizes += [peaks.get(memory.cluster, 0)] if peaks else []
        table.add_row(str(memory.cluster), *map(size_text, sizes))
    print_table(table)
    by_size = defaultdict(list)
    for name, largest in facts.growing.items():
        by_size[largest].append(name)
    for largest, names in sorted(by_size.items()):
        known = f"with messages up to {size_text(largest)}" if largest else "of unknown size"
        echo(f"not counted, {counted(len(names), 'topic')} {known}: {', '.join(names)}")


def _show_loads(traced: TracedFacts) -> None:
    echo(f"\nload in {traced.recorded.seconds:.1f} s of the trace")
    table = new_table("#cluster", "core", "#messages/s", "#CPU", "nodes")
    for core in traced.cores:
        cluster, number = map(str, core.core)
        table.add_row(cluster, number, "", f"{core.cpu_share:.1%}", ", ".join(core.nodes))
    for thread in traced.receive_threads:
        share = "-" if thread.cpu_share is None else f"{thread.cpu_share:.1%}"
        rate = f"{thread.messages_per_s:.1f}"
        table.add_row(str(thread.cluster), "receive thread", rate, share, "")
    print_table(table)
