# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Run the nodes of a mapfile from Python, and look at their platform while they talk.

    python examples/02_run_a_mapfile.py

The nodes stop at the end of the `with` block, and when this program is interrupted or killed.
"""

import threading
from pathlib import Path

import rmw_manycore_py as manycore

MAPFILE = Path(__file__).with_name("talker_listener.yaml")


def main() -> None:
    """Run until the listener has heard the talker."""
    heard = threading.Event()

    def show(node: str, line: str) -> None:
        print(f"{node} | {line}")
        if node == "listener":
            heard.set()

    with manycore.run(MAPFILE, on_output=show) as active:
        for node in active.nodes:
            print(f"{node.name} is {node.state}: pid {node.pid}, cluster {node.cluster}")
        heard.wait()
        status = manycore.status(active.platform)
    for cluster in status.clusters:
        print(f"cluster {cluster.id}: {cluster.used_bytes} of {cluster.smem_bytes} bytes used")
    for endpoint in status.endpoints:
        if endpoint.topic == "/chatter":
            print(f"{endpoint.node}: {endpoint.kind}, {endpoint.messages} messages")


if __name__ == "__main__":
    main()
