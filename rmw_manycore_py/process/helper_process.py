# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A Python process that executes functions for this one, concurrently.

```
 this process                              helper: niced, no ROS
 call(function, *arguments) ── pickle ──►  function(*arguments)
   a thread sleeps          ◄── pickle ──  its result, or its error
```

Arrays are sent out of band, without pickling. The helper ends with `close()`, and with this process
however it ends. In a run in virtual time there is none: it would compute while time goes on.
"""

from __future__ import annotations

import os
import pickle
import signal
import struct
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import IO, Any, TypeVar

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.parent_death import dies_with_this_process
from rmw_manycore_py.process.virtual_time import lives_in_virtual_time

T = TypeVar("T")

SIZE = struct.Struct("<Q")


class HelperProcess:
    """Started by the first call. Calls from several threads are serialized.

    :param name: used in messages, e.g. "map builder".
    :param niceness: next to a node on the same CPU, 5 leaves the helper a third of the time, 10 a
        tenth.
    """

    def __init__(self, name: str, niceness: int) -> None:
        self._name = name
        self._niceness = niceness
        self._process: subprocess.Popen[bytes] | None = None
        self._turn = threading.Lock()
        self._is_closed = False

    @property
    def pid(self) -> int | None:
        """Return the process id; None before the first call."""
        return None if self._process is None else self._process.pid

    def call(self, function: Callable[..., T], *arguments: Any) -> T:
        """Call a module-level function in the helper; return its result or raise its exception.

        A dead helper is restarted by the next call. In virtual time, which stands while this
        process computes, the calling thread calls the function itself.

        :raises ManycoreError: if the helper dies during the call, or is closed.
        """
        with self._turn:
            if self._is_closed:
                raise ManycoreError(f"the {self._name} process was closed")
            if lives_in_virtual_time():
                return function(*arguments)
            process = self._running()
            assert process.stdin is not None
            assert process.stdout is not None
            try:
                _send(process.stdin, (function, arguments))
                error, result = _receive(process.stdout)
            except (OSError, EOFError) as gone:
                self._end()
                raise ManycoreError(f"the {self._name} process ended unexpectedly") from gone
        if error is not None:
            raise error
        value: T = result
        return value

    def close(self) -> None:
        """Kill the helper, whatever it is doing."""
        self._is_closed = True
        process = self._process
        if process is not None:
            process.kill()
        with self._turn:  # pending calls have failed by now
            self._end()

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is not None and self._process.poll() is not None:
            self._end()
        if self._process is None:
            self._process = subprocess.Popen(
                own_program("rmw_manycore_py.process.helper_process", str(self._niceness)),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                preexec_fn=_before_exec(),
            )
        return self._process

    def _end(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None


def _before_exec() -> Callable[[], None]:
    dies = dies_with_this_process()

    def before_exec() -> None:
        dies()
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C: this process ends it

    return before_exec


def _send(pipe: IO[bytes], value: object) -> None:
    arrays: list[pickle.PickleBuffer] = []
    parts = [pickle.dumps(value, protocol=5, buffer_callback=arrays.append)]
    raw = [memoryview(parts[0]), *(array.raw() for array in arrays)]
    pipe.write(SIZE.pack(len(raw)))
    for part in raw:
        pipe.write(SIZE.pack(part.nbytes))
        pipe.write(part)
    pipe.flush()


def _receive(pipe: IO[bytes]) -> Any:
    (count,) = SIZE.unpack(_exactly(pipe, SIZE.size))
    parts = []
    for _ in range(count):
        (size,) = SIZE.unpack(_exactly(pipe, SIZE.size))
        parts.append(_exactly(pipe, size))
    return pickle.loads(parts[0], buffers=parts[1:])


def _exactly(pipe: IO[bytes], size: int) -> bytearray:
    """Return exactly `size` bytes in a writable buffer that arrays may keep."""
    data = bytearray(size)
    view, filled = memoryview(data), 0
    while filled < size:
        got = pipe.readinto(view[filled:])  # type: ignore[attr-defined]
        if not got:
            raise EOFError
        filled += got
    return data


def main() -> None:
    """Answer calls until the pipe is closed."""
    with os.fdopen(os.dup(sys.stdin.fileno()), "rb") as calls:
        answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # keep printed output out of the protocol
        leave_real_time()
        os.nice(int(sys.argv[1]))
        while True:
            try:
                function, arguments = _receive(calls)
            except EOFError:
                return
            _send(answers, _answer(function, arguments))


def _answer(function: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, Any]:
    try:
        return None, function(*arguments)
    except Exception as error:  # re-raised in the caller
        return error, None


def leave_real_time() -> None:
    """Reset the calling thread to SCHED_OTHER, which it may not have inherited."""
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


if __name__ == "__main__":
    main()
