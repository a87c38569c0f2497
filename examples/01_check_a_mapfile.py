# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Load a mapfile, find everything that it refers to, and show where each node will run.

    python examples/01_check_a_mapfile.py [MAPFILE]

Nothing is started. What is wrong comes as one error with a line for each problem.
"""

import sys
from pathlib import Path

import rmw_manycore_py as manycore

MAPFILE = Path(__file__).with_name("talker_listener.yaml")


def main(mapfile: Path) -> int:
    """Show the placement of a mapfile; return the exit status."""
    try:
        placement = manycore.resolve(manycore.load_mapfile(mapfile))
    except manycore.MapfileError as error:
        for problem in error.problems:
            print(f"{problem.file}:{problem.line} {problem.key}: expected {problem.expected}")
        return error.exit_status
    print(f"platform {placement.name}: {len(placement.topology.clusters)} clusters")
    for node in placement.nodes:
        print(f"{node.full_name}: {node.place}, host CPU {node.host_cpu}")
    for topic in placement.topics:
        print(f"{topic.name}: clusters {topic.publisher_clusters} to {topic.receiver_clusters}")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]) if len(sys.argv) > 1 else MAPFILE))
