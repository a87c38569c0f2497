# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs programs in parallel, one per CPU."""

from __future__ import annotations

import os
import selectors
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.parent_death import dies_with_this_process


@dataclass(frozen=True)
class Job:
    """A command, and its description for messages."""

    what: str
    command: Sequence[str]


def usable_cpus() -> int:
    """Return the number of CPUs of this process's affinity mask."""
    return len(os.sched_getaffinity(0))


class JobError(ManycoreError):
    """A command has failed; `output` is its complete output."""

    def __init__(self, job: Job, status: int, output: str) -> None:
        ending = f"signal {-status}" if status < 0 else f"exit status {status}"
        super().__init__(f"{job.what} failed ({ending}): {_summary(output)}")
        self.output = output


def run_jobs(
    jobs: Sequence[Job],
    directory: Path,
    environment: Mapping[str, str],
    on_done: Callable[[int], None],
) -> None:
    """Run all jobs; none of them outlives this process.

    :param directory: working directory of the jobs, and directory of their output files.
    :param on_done: called with the number of finished jobs.
    :raises JobError: for the first one that fails; the others are killed.
    """
    waiting = list(reversed(jobs))
    running: dict[int, tuple[Job, subprocess.Popen[bytes], Path]] = {}
    limit = usable_cpus()
    done = 0
    with selectors.DefaultSelector() as selector:
        try:
            while waiting or running:
                while waiting and len(running) < limit:
                    job = waiting.pop()
                    log = directory / f"job-{len(waiting)}.log"
                    process = _start(job, directory, environment, log)
                    pidfd = os.pidfd_open(process.pid)
                    running[pidfd] = (job, process, log)
                    selector.register(pidfd, selectors.EVENT_READ)
                for key, _ in selector.select():
                    selector.unregister(key.fd)
                    job, process, log = running.pop(key.fd)
                    os.close(key.fd)
                    if status := process.wait():
                        raise JobError(job, status, log.read_text(errors="replace"))
                    done += 1
                    on_done(done)
        finally:
            for pidfd, (_, process, _) in running.items():
                process.kill()
                process.wait()
                os.close(pidfd)


def _start(
    job: Job, directory: Path, environment: Mapping[str, str], log: Path
) -> subprocess.Popen[bytes]:
    with log.open("wb") as output:
        return subprocess.Popen(
            job.command,
            cwd=directory,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            preexec_fn=dies_with_this_process(),
        )


def _summary(output: str) -> str:
    """Return the first line with an error, else the last line."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    wrong = [line[line.index("error:") :] for line in lines if "error:" in line]
    return (wrong or lines[-1:] or ["it printed nothing"])[0]
