# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Memory use of a node and of a cluster."""

from __future__ import annotations

import re
from pathlib import Path

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, MIB, Middleware
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import Process, Session
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.platform.topology import platforms_directory

NODES = 8
NAME = "memory"
KIB = 1024
COOLIDGE_SMEM_BYTES = 4 * MIB


def measure(run: Run) -> list[Result]:
    """Return a table like that of ROS-lite: memory of the system, and what each node adds."""
    run.note("memory: rmw_manycore")
    results = _measure_manycore(run) if run.wants(INSIDE.name) else []
    for middleware in (INSIDE, FAST_DDS):
        if run.wants(middleware.name):
            run.note(f"memory of a node: {middleware.name}")
            results += _measure_nodes(run, middleware)
    return results


def _measure_manycore(run: Run) -> list[Result]:
    with Session(INSIDE, run.cpus) as session:
        first = _start_nodes(session, 0, 1)
        alone = session.shared_sizes()
        (receive_thread,) = session.receive_thread_pids()
        thread = private_bytes(receive_thread)
        more = _start_nodes(session, 1, NODES)
        together = session.shared_sizes()
        _stop_nodes(first + more)
    cluster = "cluster-1"
    return [
        _row("platform: registry", alone["registry"]),
        _row("cluster: segment with one node", alone[cluster]),
        _row("cluster: left for topic data of 4 MiB SMEM", COOLIDGE_SMEM_BYTES - alone[cluster]),
        _row("cluster: receive thread, private", thread),
        _row("node: its share of the segment", (together[cluster] - alone[cluster]) / NODES),
        _row("node: its share of the registry", (together["registry"] - alone["registry"]) / NODES),
    ]


def _measure_nodes(run: Run, middleware: Middleware) -> list[Result]:
    results = []
    for kind, count in (("rmw", NODES), ("rclpy", 2)):
        with Session(middleware, run.cpus) as session:
            nodes = _start_nodes(session, 0, count, rclpy=kind == "rclpy")
            sizes = [private_bytes(node.pid) for node in nodes]
            _stop_nodes(nodes)
        name = f"{kind} node, private: {middleware.name}"
        results.append(Result(NAME, name, "KiB", tuple(size / KIB for size in sizes)))
    return results


def _row(name: str, size_bytes: float) -> Result:
    return Result(NAME, name, "KiB", (size_bytes / KIB,))


def _start_nodes(session: Session, first: int, count: int, rclpy: bool = False) -> list[Process]:
    nodes = []
    for party in range(first, first + count):
        name = f"node_{party}"
        node = (
            session.python("idle", party, name)
            if rclpy
            else session.native("idle_node", party, name=name)
        )
        node.wait_until_ready()
        nodes.append(node)
    return nodes


def _stop_nodes(nodes: list[Process]) -> None:
    for node in nodes:
        node.release()
        node.finish()


def private_bytes(pid: int) -> int:
    """Return the private memory of a process, without shared memory that only it has touched."""
    total = 0
    shared = ("/dev/shm/", f"{platforms_directory()}/")  # Fast DDS and rmw_manycore
    counts = False
    for line in Path(f"/proc/{pid}/smaps").read_text().splitlines():
        if re.match(r"[0-9a-f]+-[0-9a-f]+ ", line):
            counts = not any(place in line for place in shared)
        elif counts and line.startswith("Private_"):
            total += int(line.split()[1]) * KIB
    return total


QUESTION = Question("memory", measure, (), "nodes on both CPUs in turn, all in cluster 1")
