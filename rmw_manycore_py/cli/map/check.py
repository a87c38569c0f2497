# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore map check`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import counted, echo, print_json, print_notices
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.mapfile.placing.moves import RoomError


@click.command("check", epilog=examples("manycore map check talker_listener"))
@mapfile_argument()
@json_option
def command(mapfile: Path, as_json: bool) -> None:
    """Check MAPFILE and everything it refers to.

    Nothing is started.
    """
    try:
        placement = resolve(load_mapfile(mapfile), to_start=False)
    except MapfileError as error:
        if as_json:
            print_json(_refused(error))
        raise
    missing = {node.full_name: node.missing for node in placement.nodes if node.missing}
    if as_json:
        print_json({"valid": True, "notices": placement.notices, "missing": missing})
        return
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
