# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Starts the processes of one measurement, each pinned to its CPU."""

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
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import IO, Any, NoReturn

from rmw_manycore_hook import plain_environment
from rmw_manycore_program import own_program
from rmw_manycore_py.bench.contenders import Middleware, Peer
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import Platform, platform_directory
from rmw_manycore_py.process.parent_death import dies_with_this_process

# Total timeout of a process.
TIMEOUT_S = 300.0
NODES = "rmw_manycore_py.bench.nodes"

# Keeps the start-up hook of the ROS 2 wheels from rearranging the library path.
WHEELS_BOOTSTRAPPED = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"

_numbers = itertools.count()


def native_directory() -> Path:
    """Return the directory of the installed native parts."""
    return Path(sys.prefix, "lib", "rmw_manycore")


def program_path(name: str) -> Path:
    """Return the path of a native bench program; raise ManycoreError if it was not built."""
    path = native_directory() / "bench" / name
    if not path.exists():
        raise ManycoreError(
            f"the bench program {path} is not there: this rmw_manycore was built without "
            "-DMANYCORE_BUILD_BENCH=ON"
        )
    return path


def native_command(program: str, **arguments: object) -> list[str | Path]:
    """Return the command line of a native bench program, which dies with this process."""
    words = (f"{key}={value}" for key, value in arguments.items())
    return [program_path(program), _parent(), *words]


def _parent() -> str:
    return f"parent={os.getpid()}"


def usable_cpus() -> tuple[int, int]:
    """Return the CPUs of the two parties; equal if the machine has only one."""
    cpus = sorted(os.sched_getaffinity(0))
    return cpus[0], cpus[min(1, len(cpus) - 1)]


@contextmanager
def pinned_to(cpus: Sequence[int]) -> Iterator[None]:
    """Pin this process during the block, so that started processes inherit the affinity."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, cpus)
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


class Process:
    """A process that prints `ready` and finally a line of JSON."""

    def __init__(
        self,
        name: str,
        command: Sequence[str | Path],
        env: dict[str, str],
        cpus: Sequence[int],
        *,
        output: IO[str] | None = None,
        timeout_s: float = TIMEOUT_S,
    ) -> None:
        """Start the process; `output` receives what it prints, instead of this object."""
        self._name = name
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115
        # With a preexec_fn, Python forks, which takes milliseconds with memory as large as this.
        ties_itself = _parent() in command
        with pinned_to(cpus):
            self.started_ns = time.monotonic_ns()
            self._process = subprocess.Popen(
                [str(word) for word in command],
                env=env,
                text=True,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE if output is None else output,
                stderr=self._errors,
                preexec_fn=None if ties_itself else dies_with_this_process(),
            )
        self._timer = self._killed_after(timeout_s)

    def give(self, timeout_s: float) -> None:
        """Let the process live for this long from now, whatever its timeout was."""
        self._timer.cancel()
        self._timer = self._killed_after(timeout_s)

    @property
    def pid(self) -> int:
        """Return the process id."""
        return self._process.pid

    def wait_until_ready(self) -> None:
        """Wait until the process has reported ready."""
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.strip() == "ready":
                return
        self.finish()

    def next_line(self) -> str:
        """Return the next line of output; raise ManycoreError after its end."""
        assert self._process.stdout is not None
        return self._process.stdout.readline() or self._fail()

    def send_line(self, line: str) -> None:
        """Write a line to the process's input; raise ManycoreError if it has ended."""
        self.raise_if_failed()
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(f"{line}\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            self._fail()

    def release(self) -> None:
        """Close the process's input, which some programs wait for."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.stdin = None

    def finish(self) -> dict[str, Any]:
        """Wait for a successful exit and return the JSON result."""
        output = self._process.communicate()[0] or ""
        if self._process.returncode != 0:
            self._errors.seek(0)
            raise ManycoreError(
                f"{self._name}: {self._process.args!r} ended with exit status "
                f"{self._process.returncode}:\n" + self._errors.read()
            )
        lines = [line for line in output.splitlines() if line.startswith("{")]
        result: dict[str, Any] = json.loads(lines[-1]) if lines else {}
        return result

    def raise_if_failed(self) -> None:
        """Raise ManycoreError if the process has ended early."""
        if self._process.poll() is not None:
            self._fail()

    def interrupt(self) -> None:
        """Send SIGINT."""
        self._process.send_signal(signal.SIGINT)

    def close(self) -> None:
        """Kill the process and close the pipes."""
        self._timer.cancel()
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._errors):
            _close(stream)

    def _killed_after(self, timeout_s: float) -> threading.Timer:
        timer = threading.Timer(timeout_s, self._process.kill)
        timer.start()
        return timer

    def _fail(self) -> NoReturn:
        self.finish()
        raise ManycoreError(f"{self._name}: {self._process.args!r} has ended early")


def _close(stream: IO[str] | None) -> None:
    if stream is not None:
        with suppress(BrokenPipeError):  # of what the process did not read
            stream.close()


class Session:
    """One middleware with its own platform and ROS domain, for one measurement."""

    def __init__(
        self, middleware: Middleware, cpus: Sequence[int], timeout_s: float = TIMEOUT_S
    ) -> None:
        """Prepare parties on alternating CPUs; each is killed after `timeout_s`."""
        self.middleware = middleware
        self.platform = f"bench-{os.getpid()}-{next(_numbers)}"
        self._cpus = cpus
        self._timeout_s = timeout_s
        self._stack = ExitStack()
        # Fast DDS derives its ports from the domain; above 100 they overlap the ephemeral range.
        self.domain = (os.getpid() + next(_numbers)) % 100 + 1

    def __enter__(self) -> Session:
        self._profile = self._write_profile()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def native(self, program: str, party: int, **arguments: object) -> Process:
        """Start a native program as a party, on its CPU and in its cluster."""
        return self.start(native_command(program, **arguments), party)

    def python(
        self,
        module: str,
        party: int,
        *arguments: object,
        by_hand: bool = False,
        cpus: Sequence[int] | None = None,
    ) -> Process:
        """Start an rclpy program as a party; `by_hand` leaves the library path unset.

        :param cpus: overrides the party's CPU.
        """
        command = own_program(f"{NODES}.{module}", *map(str, arguments))
        return self.start(command, party, with_library_path=not by_hand, cpus=cpus)

    def module(self, name: str, party: int, *arguments: object) -> Process:
        """Start a module of ours as a party."""
        return self.start(own_program(name, *map(str, arguments)), party)

    def start(
        self,
        command: Sequence[str | Path],
        party: int,
        with_library_path: bool = True,
        output: IO[str] | None = None,
        cpus: Sequence[int] | None = None,
    ) -> Process:
        """Start a command as a party; `output` receives its output.

        :param cpus: overrides the party's CPU.
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
            timeout_s=self._timeout_s,
        )
        self._stack.callback(process.close)
        return process

    def receive_thread_pids(self) -> list[int]:
        """Return the processes of the clusters' receive threads, once all have started."""
        if not self.middleware.is_manycore:
            return []
        deadline = time.monotonic() + TIMEOUT_S
        with Platform(self.platform) as platform:
            while time.monotonic() < deadline:
                clusters = platform.clusters()
                pids = [cluster.receive_thread_pid for cluster in clusters if cluster.alive]
                if len(pids) == len(clusters) and all(pids):  # it is alive before its pid is set
                    return pids
                time.sleep(0.01)
        raise ManycoreError(f"{self.platform}: a receive thread does not start")

    def shared_sizes(self) -> dict[str, int]:
        """Return the memory in bytes of each file of the platform."""
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
    """Return the library directories that give a program this middleware."""
    prefix = Path(sys.prefix)
    libraries = [prefix / "lib", *sorted(prefix.glob("lib/python*/site-packages/ros_*.libs"))]
    given = plain_environment(os.environ, sys.prefix).get("LD_LIBRARY_PATH", "").split(os.pathsep)
    standin = [native_directory() / "standin"] if middleware.is_manycore else []
    other = [middleware.build] if middleware.build else []
    # Stand-ins first: the directory of the other library may contain the library they replace.
    return [str(path) for path in [*standin, *other, *libraries, *given] if str(path)]


def run_peer(peer: Peer, cpus: tuple[int, int], **arguments: Any) -> dict[str, Any]:
    """Run a peer to its end and return its result."""
    return run_program(peer.program, cpu_1=cpus[0], cpu_2=cpus[1], **arguments)


def run_program(
    program: str, /, *, timeout_s: float = TIMEOUT_S, **arguments: object
) -> dict[str, Any]:
    """Run a native bench program, which pins itself, to its end and return its result."""
    command = native_command(program, **arguments)
    cpus = sorted(os.sched_getaffinity(0))
    process = Process(program, command, dict(os.environ), cpus, timeout_s=timeout_s)
    try:
        return process.finish()
    finally:
        process.close()
