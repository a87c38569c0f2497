# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore map check`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option, rates_option
from rmw_manycore_py.cli.common.printing import counted, echo, print_json, print_notices
from rmw_manycore_py.cli.common.rates import load_rates
from rmw_manycore_py.errors import EXIT_FAILURE, MapfileError
from rmw_manycore_py.mapfile import Placement, load_mapfile, resolve
from rmw_manycore_py.mapfile.mapping import facts_of
from rmw_manycore_py.mapfile.mapping.verdict import as_data, fit_of, verdict
from rmw_manycore_py.mapfile.placing.moves import Proposal, RoomError
from rmw_manycore_py.mapfile.placing.room import Placed
from rmw_manycore_py.mapfile.placing.show import cluster_row


@click.command(
    "check",
    epilog=examples(
        "manycore map check talker_listener", "manycore map check map.yaml --trace trace.json"
    ),
)
@mapfile_argument()
@rates_option
@json_option
def command(mapfile: Path, trace: Path | None, as_json: bool) -> None:
    """Check MAPFILE and everything it refers to.

    Nothing is started. The verdict states whether it fits, and what crosses clusters; with a trace,
    at which rates.
    """
    checked = load_mapfile(mapfile)
    try:
        placement = resolve(checked, to_start=False)
    except MapfileError as error:
        if as_json:
            print_json(_refused(error))
        raise
    facts = facts_of(placement, load_rates(trace) if trace else None)
    missing = {node.full_name: node.missing for node in placement.nodes if node.missing}
    fit = fit_of(facts)
    advice = None if fit == "fits" else Proposal.of(Placed(checked, placement.nodes))
    if as_json:
        print_json(
            {
                "valid": True,
                "notices": placement.notices,
                "missing": missing,
                "clusters": [cluster_row(placement, memory) for memory in placement.memory],
                "mapping": as_data(facts),
                **(advice.data() if advice else {}),
            }
        )
    else:
        _show(mapfile, placement, missing)
        echo(f"verdict: {verdict(facts)}")
        for line in advice.lines() if advice else ():
            echo(line)
    if fit == "too small":
        click.get_current_context().exit(EXIT_FAILURE)


def _show(mapfile: Path, placement: Placement, missing: Mapping[str, str]) -> None:
    print_notices(placement.notices)
    nodes = counted(len(placement.nodes), "node")
    clusters = counted(len({node.cluster for node in placement.nodes}), "cluster")
    echo(f"{mapfile}: {nodes} in {clusters}, {counted(len(placement.topics), 'topic')}: valid")
    for name, reason in missing.items():
        echo(f"{name} cannot run here: {reason}")
    if missing:
        echo(f"a plan: {len(missing)} of {nodes} cannot run here")


def _refused(error: MapfileError) -> dict[str, Any]:
    """Return the problems as JSON data, with advice on room."""
    problems = [vars(problem) for problem in error.problems]
    advice = error.advice.data() if isinstance(error, RoomError) else {}
    return {"valid": False, "problems": problems, **advice}
