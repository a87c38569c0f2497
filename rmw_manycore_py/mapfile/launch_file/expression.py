# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Evaluates the Python expression of `$(eval)` in a separate process with limits.

Whether an expression terminates cannot be checked in advance, and `9**9**9` holds the interpreter
lock: only another process can bound time and memory. That process runs this file.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import resource
import signal
import sys
import time
from collections.abc import Sequence
from typing import Any

# In addition to the interpreter and the imported modules.
CPU_S = 2
MEMORY_BYTES = 1 << 30
# Wall-clock limit, for expressions that block.
TIMEOUT_S = 60


def evaluate(text: str, modules: Sequence[str]) -> str:
    """Return the value of an expression as text; raise ValueError on any failure."""
    # Imported here: the child process that runs this file does not need the package.
    from rmw_manycore_py.mapfile.launch_file.child import ChildBoundError, run_child

    request = json.dumps({"text": text, "modules": list(modules), "path": sys.path})
    words = (sys.executable, "-I", __file__)
    try:
        done = run_child(words, os.environ, TIMEOUT_S, request.encode())
        answer = json.loads(done.stdout.rpartition("\n")[2]) if done.returncode == 0 else None
    except (ChildBoundError, ValueError) as error:
        raise ValueError(str(error)) from error
    if answer is None:
        raise ValueError(
            f"no end after {CPU_S} s of computing"
            if done.returncode == -signal.SIGXCPU
            else f"it ended its process with status {done.returncode}"
        )
    if "error" in answer:
        raise ValueError(answer["error"])
    return str(answer["value"])


def _main() -> None:
    request = json.load(sys.stdin)
    sys.path[:] = request["path"]
    try:
        answer = {"value": _value(request["text"], request["modules"])}
    except BaseException as error:
        answer = {"error": str(error) or type(error).__name__}
    # Follows any output of the expression itself.
    sys.stdout.write(f"\n{json.dumps(answer)}")


def _value(text: str, names: Sequence[str]) -> str:
    modules: dict[str, Any] = {name: importlib.import_module(name) for name in names}
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_CPU, math.ceil(time.process_time()) + CPU_S)
    _limit(resource.RLIMIT_AS, _address_space_bytes() + MEMORY_BYTES)
    # Names of the module math need no prefix, as in ros2 launch.
    return str(eval(text, {**vars(modules.get("math", os)), **modules}))


def _limit(kind: int, value: int) -> None:
    _, hard = resource.getrlimit(kind)
    soft = value if hard == resource.RLIM_INFINITY else min(value, hard)
    resource.setrlimit(kind, (soft, hard))


def _address_space_bytes() -> int:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[0]) * resource.getpagesize()


if __name__ == "__main__":
    _main()
