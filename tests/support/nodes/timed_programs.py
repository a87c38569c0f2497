# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs of the Python API that print what time they see: `timed_programs.py PROGRAM`."""

from __future__ import annotations

import ctypes
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np

from rmw_manycore_py import transport
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import now_ns
from rmw_manycore_py.ndt.maps.map_builder import MapBuilder
from rmw_manycore_py.ndt.matching.options import MatcherOptions
from rmw_manycore_py.ndt.nodes.scan_matcher.stage_times import StageTimes
from rmw_manycore_py.papers.roslite.localization.remote_pass import RemotePass

_START_NS = 10**18
_POINTS = np.zeros(3, np.float32)
_FUTEX = "202"


def _compute() -> None:
    """Use 5 ms of CPU time."""
    end_s = time.thread_time() + 0.005
    while time.thread_time() < end_s:
        pass


def computing() -> None:
    """Compute before a publish and before a wait; print how long each took."""
    with transport.join() as member:
        publisher = member.publisher("/points", np.float32)
        subscription = member.subscription("/points", np.float32)
        begin_ns = now_ns()
        _compute()
        publisher.publish(_POINTS)
        print(now_ns() - begin_ns, flush=True)
        subscription.take().release()
        begin_ns = now_ns()
        _compute()
        try:
            subscription.take(0.01)
        except transport.TransportTimeoutError:
            print(now_ns() - begin_ns, flush=True)


def threads() -> None:
    """Print when a thread that has waited for nothing publishes, and the time that it sees."""
    with transport.join() as member:
        publisher = member.publisher("/points", np.float32)
        subscription = member.subscription("/points", np.float32)
        time.sleep(0.5)

        def publish() -> None:
            publisher.publish(_POINTS)
            print(time.time_ns() - _START_NS, flush=True)

        thread = threading.Thread(target=publish)
        thread.start()
        with subscription.take() as message:
            thread.join()  # or the two print into each other's line
            print(message.source_timestamp_ns - _START_NS, flush=True)


def leaver() -> None:
    """Have a thread that sleeps after the destructors of its thread-local objects have run."""
    libc = ctypes.CDLL(None)
    key = ctypes.c_uint()
    libc.pthread_key_create(ctypes.byref(key), libc.usleep)

    def work() -> None:
        time.sleep(0.5)
        libc.pthread_setspecific(key, ctypes.c_void_p(100_000))

    with transport.join():
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        begin_s = time.monotonic()
        while Path(f"/proc/self/task/{thread.native_id}").exists():
            pass
        print(now_ns() - _START_NS, time.monotonic() - begin_s >= 0.05, flush=True)


def crowd() -> None:
    """Have more threads than may wait at a time."""
    threading.stack_size(64 * 1024)
    with transport.join():
        for _ in range(2100):
            threading.Thread(target=time.sleep, args=(1.0,), daemon=True).start()
        time.sleep(0.5)


def builder() -> None:
    """Have maps built in the background; print how long each took by two clocks, in ms."""
    generator = np.random.default_rng(1)
    with transport.join():
        maps = MapBuilder(MatcherOptions())
        for _ in range(2):  # the second one would be the helper's
            begin_ns = now_ns()
            maps.submit(lambda: generator.uniform(-20.0, 20.0, (50_000, 3)))
            while (built := maps.take()) is None:
                time.sleep(0.1)
            passed_ms = (now_ns() - begin_ns) // 1_000_000
            print(passed_ms, built.duration_ms, built.problem, flush=True)
        maps.close()


def stages() -> None:
    """Print how long a stage of a scan took that has used 5 ms of CPU time."""
    with transport.join():
        stages = StageTimes()
        _compute()
        print(stages.total_ms, flush=True)


def passes() -> None:
    """Have a thread give up a pass that takes longer than a second; print when, in s."""
    with transport.join() as member:
        publisher = member.publisher("/points", np.float32)
        remote = RemotePass(lambda *_: publisher.publish(_POINTS), parts=1, timeout_s=1.0)

        def ask() -> None:
            try:
                remote(np.eye(4))
            except ManycoreError:
                print((now_ns() - _START_NS) / 1e9, flush=True)

        thread = threading.Thread(target=ask)
        thread.start()
        while thread.is_alive():
            time.sleep(0.25)
            remote.look()


def early() -> None:
    """End after 0.1 s: its place is given again."""
    with transport.join():
        time.sleep(0.1)


def family() -> None:
    """Start another process when `early` has ended; both publish every 0.1 s."""
    with transport.join():
        time.sleep(0.2)
        child = subprocess.Popen([sys.executable, __file__, "child"])
        while not _waits_to_join(child.pid):
            pass  # time stands
        _publish(1)


def _waits_to_join(pid: int) -> bool:
    """Return whether a process waits for its time; while it starts it waits on other words."""
    number, *words = Path(f"/proc/{pid}/syscall").read_text().split()
    if number != _FUTEX:
        return False
    address = int(words[0], 16)
    for line in Path(f"/proc/{pid}/maps").read_text().splitlines():
        first, last = (int(word, 16) for word in line.split()[0].split("-"))
        if first <= address < last:
            return "memfd:virtual_time" in line
    return False


def child() -> None:
    """Publish every 0.1 s."""
    with transport.join():
        _publish(2)


def _publish(number: int) -> None:
    with transport.join() as member:
        publisher = member.publisher("/numbers", np.float32)
        for _ in range(3):
            time.sleep(0.1)
            publisher.publish(np.full(1, number, np.float32))


def ear() -> None:
    """Print who publishes, and when."""
    with transport.join() as member:
        subscription = member.subscription("/numbers", np.float32)
        for _ in range(6):
            with subscription.take() as message:
                at_ms = (message.source_timestamp_ns - _START_NS) // 1_000_000
                print(at_ms, int(message.array[0]), flush=True)


if __name__ == "__main__":
    globals()[sys.argv[1]]()
