# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Starting the processes of one measurement, each pinned to its CPU."""

from __future__ import annotations

import itertools
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any

from rmw_manycore_hook import plain_environment
from rmw_manycore_program import own_program
from rmw_manycore_py._transport import Platform, platform_directory
from rmw_manycore_py.bench.contenders import Middleware, Peer
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.parent_death import dies_with_this_process

# How long a process may take in all before a bench gives up on it.
PATIENCE_S = 300.0
NODES = "rmw_manycore_py.bench.nodes"

# In the ROS 2 wheels this keeps the start-up hook from rearranging the library path.
WHEELS_BOOTSTRAPPED = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"

_numbers = itertools.count()


def native_directory() -> Path:
    """Return where the native parts of rmw_manycore are installed."""
    return Path(sys.prefix, "lib", "rmw_manycore")


def program_path(name: str) -> Path:
    """Return a native bench program, or say how to get it."""
    path = native_directory() / "bench" / name
    if not path.exists():
        raise ManycoreError(
            f"the bench program {path} is not there: this rmw_manycore was built without "
            "-DMANYCORE_BUILD_BENCH=ON"
        )
    return path


def native_command(program: str, **arguments: object) -> list[str | Path]:
    """Return the command line of a native bench program."""
    return [program_path(program), *(f"{key}={value}" for key, value in arguments.items())]


def usable_cpus() -> tuple[int, int]:
    """Return the two CPUs of the parties; they are one where the machine has no more."""
    cpus = sorted(os.sched_getaffinity(0))
    return cpus[0], cpus[min(1, len(cpus) - 1)]


@contextmanager
def pinned_to(cpus: Sequence[int]) -> Iterator[None]:
    """Pin this process, so that those it starts meanwhile are pinned from their first moment."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, cpus)
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


class Process:
    """A started process that says `ready` when it is, and ends with a line of JSON."""

    def __init__(
        self,
        name: str,
        command: Sequence[str | Path],
        env: dict[str, str],
        cpus: Sequence[int],
        *,
        output: IO[str] | None = None,
        patience_s: float = PATIENCE_S,
    ) -> None:
        """`output`: takes what the process prints, which then says nothing here."""
        self._name = name
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115
        with pinned_to(cpus):
            self.started_ns = time.monotonic_ns()
            self._process = subprocess.Popen(
                [str(word) for word in command],
                env=env,
                text=True,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE if output is None else output,
                stderr=self._errors,
                preexec_fn=dies_with_this_process(),
            )
        self._end_of_patience = threading.Timer(patience_s, self._process.kill)
        self._end_of_patience.start()

    @property
    def pid(self) -> int:
        """Return the process id."""
        return self._process.pid

    def wait_until_ready(self) -> None:
        """Return when the process has done its part of the set-up."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.strip() == "ready":
                return
        self.finish()

    def next_line(self) -> str:
        """Return the next line that the process prints; "" where it has ended."""
        assert self._process.stdout is not None
        return self._process.stdout.readline()

    def release(self) -> None:
        """End the input of the process, for which some wait before they end themselves."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.stdin = None

    def finish(self) -> dict[str, Any]:
        """Return what the process found, once it has ended well."""
        output = self._process.communicate()[0] or ""
        if self._process.returncode != 0:
            self._errors.seek(0)
            raise ManycoreError(
                f"{self._name}: {self._process.args!r} ended with status "
                f"{self._process.returncode}:\n" + self._errors.read()
            )
        lines = [line for line in output.splitlines() if line.startswith("{")]
        result: dict[str, Any] = json.loads(lines[-1]) if lines else {}
        return result

    def raise_if_failed(self) -> None:
        """Raise the error of a process that has ended before it should."""
        if self._process.poll() is not None:
            self.finish()
            raise ManycoreError(f"{self._name}: {self._process.args!r} has ended early")

    def interrupt(self) -> None:
        """Send the SIGINT that ends nodes."""
        self._process.send_signal(signal.SIGINT)

    def close(self) -> None:
        """End the process, whatever it is doing, and close our ends of its pipes."""
        self._end_of_patience.cancel()
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._errors):
            _close(stream)


def _close(stream: IO[str] | None) -> None:
    if stream is not None:
        stream.close()


class Session:
    """One middleware with a platform and a ROS domain of its own, for one measurement."""

    def __init__(
        self, middleware: Middleware, cpus: Sequence[int], patience_s: float = PATIENCE_S
    ) -> None:
        """Prepare parties that have the CPUs in turn; after `patience_s` each is killed."""
        self.middleware = middleware
        self.platform = f"bench-{os.getpid()}-{next(_numbers)}"
        self._cpus = cpus
        self._patience_s = patience_s
        self._stack = ExitStack()
        # Fast DDS takes its ports from the domain; above 100 they reach into those of clients.
        self.domain = (os.getpid() + next(_numbers)) % 100 + 1

    def __enter__(self) -> Session:
        self._profile = self._write_profile()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def native(self, program: str, party: int, **arguments: object) -> Process:
        """Start a native program as a party, on its CPU and in its cluster."""
        return self.start(native_command(program, **arguments), party)

    def python(self, module: str, party: int, *arguments: object, by_hand: bool = False) -> Process:
        """Start an rclpy program as a party; by hand means without the library path set."""
        command = own_program(f"{NODES}.{module}", *map(str, arguments))
        return self.start(command, party, with_library_path=not by_hand)

    def module(self, name: str, party: int, *arguments: object) -> Process:
        """Start any module of ours as a party."""
        return self.start(own_program(name, *map(str, arguments)), party)

    def start(
        self,
        command: Sequence[str | Path],
        party: int,
        with_library_path: bool = True,
        output: IO[str] | None = None,
        cpus: Sequence[int] | None = None,
    ) -> Process:
        """Start any command as a party; `output` takes what it prints.

        :param cpus: instead of the party's.
        """
        environment = self._environment(party)
        if with_library_path:
            environment["LD_LIBRARY_PATH"] = os.pathsep.join(library_path(self.middleware))
            environment[WHEELS_BOOTSTRAPPED] = "1"
        process = Process(
            self.middleware.name,
            command,
            environment,
            cpus or [self._cpus[party % len(self._cpus)]],
            output=output,
            patience_s=self._patience_s,
        )
        self._stack.callback(process.close)
        return process

    def receive_thread_pids(self) -> list[int]:
        """Return the processes of the clusters' receive threads, once all have started."""
        if not self.middleware.is_manycore:
            return []
        deadline = time.monotonic() + PATIENCE_S
        with Platform(self.platform) as platform:
            while time.monotonic() < deadline:
                clusters = platform.clusters()
                pids = [cluster.receive_thread_pid for cluster in clusters if cluster.alive]
                if len(pids) == len(clusters) and all(pids):  # it lives before it says its pid
                    return pids
                time.sleep(0.01)
        raise ManycoreError(f"{self.platform}: a receive thread does not start")

    def shared_sizes(self) -> dict[str, int]:
        """Return the bytes of memory that each file of the platform holds."""
        files = Path(platform_directory(self.platform)).iterdir()
        return {file.name: file.stat().st_blocks * 512 for file in files}

    def _environment(self, party: int) -> dict[str, str]:
        middleware = self.middleware
        result = {
            **plain_environment(os.environ, sys.prefix),
            **middleware.variables,
            "MANYCORE_PLATFORM": self.platform,
            "MANYCORE_CLUSTER": str(middleware.cluster_of(party)),
            "ROS_DOMAIN_ID": str(self.domain),
        }
        for name in ("MANYCORE_CORE", WHEELS_BOOTSTRAPPED):
            result.pop(name, None)
        if self._profile:
            result["FASTRTPS_DEFAULT_PROFILES_FILE"] = str(self._profile)
        return result

    def _write_profile(self) -> Path | None:
        if self.middleware.profile is None:
            return None
        directory = self._stack.enter_context(tempfile.TemporaryDirectory())
        path = Path(directory, "fastdds.xml")
        path.write_text(self.middleware.profile)
        return path


def library_path(middleware: Middleware) -> list[str]:
    """Return the directories that give a program this middleware under the name it asks for."""
    prefix = Path(sys.prefix)
    libraries = [prefix / "lib", *sorted(prefix.glob("lib/python*/site-packages/ros_*.libs"))]
    given = plain_environment(os.environ, sys.prefix).get("LD_LIBRARY_PATH", "").split(os.pathsep)
    standin = [native_directory() / "standin"] if middleware.is_manycore else []
    other = [middleware.library] if middleware.library else []
    # The stand-ins first: beside the other library there may be the one that they stand in for.
    return [str(path) for path in [*standin, *other, *libraries, *given] if str(path)]


def run_peer(peer: Peer, cpus: tuple[int, int], **arguments: object) -> dict[str, Any]:
    """Run a peer to its end and return what it found."""
    words = [f"{key}={value}" for key, value in arguments.items()]
    command = [str(program_path(peer.program)), f"cpu_1={cpus[0]}", f"cpu_2={cpus[1]}", *words]
    process = Process(peer.name, command, dict(os.environ), sorted(os.sched_getaffinity(0)))
    try:
        return process.finish()
    finally:
        process.close()
