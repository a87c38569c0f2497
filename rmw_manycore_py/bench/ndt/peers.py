# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Published matchers as processes that answer line by line, each on its CPUs."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.ndt.world import world
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.birth import pinned_to
from rmw_manycore_py.process.parent_death import dies_with_this_process
from rmw_manycore_py.ros.ament import package_share

PCL_PACKAGES = ("pcl_registration", "pcl_registration-1.12", "pcl_registration-1.14")
PCL_FLAGS = ("-O3", "-DNDEBUG", "-std=c++17")
# Flags of its own CMakeLists.txt.
PCLOMP_FLAGS = (
    *("-O3", "-DNDEBUG", "-std=c++14", "-fopenmp", "-DPEER_PCLOMP"),
    *("-msse", "-msse2", "-msse3", "-msse4", "-msse4.1", "-msse4.2"),
)
PYTHON_PEERS = ("small_gicp", "open3d")


class Peer:
    """A peer process with a request-response protocol."""

    def __init__(self, name: str, process: subprocess.Popen[str]) -> None:
        self.name = name
        self._process = process
        while (line := self._read()) != "ready":
            if not line:
                raise ManycoreError(f"{name} ended with exit status {process.wait()}")

    def ask(self, question: str, scan: int) -> list[float]:
        """Return the numbers of its answer; the first is a time in ns."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{question} {scan}\n")
        self._process.stdin.flush()
        return [float(word) for word in self._read().split()]

    def _read(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline().strip()


@contextmanager
def all_peers(
    cpus: Sequence[int],
    voxel_size_m: float,
    pclomp: Path | None,
    wanted: Sequence[str],
    threads: int = 1,
) -> Iterator[dict[str, Peer]]:
    """Start the available peers on these CPUs; report missing ones on standard error.

    :param threads: of pclomp.
    """
    with ExitStack() as stack:
        directory = Path(stack.enter_context(TemporaryDirectory(prefix="manycore-bench-")))
        world().write(directory / "world")
        peers = {}
        for name in wanted:
            command = _command(name, directory, pclomp)
            if command:
                words = [*command, str(directory / "world"), str(voxel_size_m)]
                if name == "pclomp":
                    words.append(str(threads))
                peers[name] = stack.enter_context(_started(name, words, cpus, threads))
        yield peers


@contextmanager
def _started(
    name: str, command: Sequence[str], cpus: Sequence[int], threads: int
) -> Iterator[Peer]:
    with pinned_to(tuple(cpus)):
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "OMP_NUM_THREADS": str(threads)},
            preexec_fn=dies_with_this_process(),
        )
    try:
        yield Peer(name, process)
    finally:
        process.kill()
        process.communicate()


def _command(name: str, directory: Path, pclomp: Path | None) -> list[str]:
    if name in PYTHON_PEERS:
        if find_spec(name) is None:
            return _missing(name, f"pip install {name.replace('open3d', 'open3d-cpu')}")
        return [*own_program("rmw_manycore_py.bench.ndt.python_peer", name)]
    flags = _pcl_flags()
    if not flags:
        return _missing(name, "apt-get install libpcl-dev pkg-config g++")
    if name == "pclomp" and pclomp is None:
        return _missing(name, "--pclomp DIRECTORY, a checkout of ndt_omp")
    program = directory / name
    own = (*PCLOMP_FLAGS, f"-I{pclomp}/include") if name == "pclomp" else PCL_FLAGS
    built = subprocess.run(
        ["g++", *own, str(_pcl_peer()), "-o", str(program), *flags], capture_output=True, text=True
    )
    if built.returncode != 0:
        raise ManycoreError(f"{name} does not compile:\n{built.stderr[:2000]}")
    return [str(program)]


def _pcl_peer() -> Path:
    """Return the installed source of the peers built against PCL."""
    share = package_share("rmw_manycore")
    if share is None:
        raise ManycoreError("rmw_manycore is not in the ament index: install it again")
    return share / "bench/peer.cpp"


def _pcl_flags() -> list[str]:
    if shutil.which("pkg-config") is None or shutil.which("g++") is None:
        return []
    for package in PCL_PACKAGES:
        found = subprocess.run(
            ["pkg-config", "--cflags", "--libs", package], capture_output=True, text=True
        )
        if found.returncode == 0:
            return found.stdout.split()
    return []


def _missing(name: str, remedy: str) -> list[str]:
    print(f"{name} takes no part: {remedy}", file=sys.stderr)
    return []
