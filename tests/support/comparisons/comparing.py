# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generated inputs, each read by us and by the real reader of its format.

A comparison is a program, because readers keep state and print: it is a module of this package,
run in tests/ as python -m MODULE DIRECTORY FIRST END.
It derives each input from its number alone. It reports each input on which the two disagree, or
which ends in an error that users must not see.
"""

from __future__ import annotations

import faulthandler
import json
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from support import TESTS

FEW = 200  # the others are left to tests/stress
MANY = int(os.environ.get("MANYCORE_TEST_COMPARED_FILES", "10000"))
# Far above what any input takes on a busy machine: only an endless loop takes longer.
HANG_S = 120

Compare = Callable[[Path, int], str]


class DisagreementError(Exception):
    """We and the real reader read an input differently."""


def run(compare: Compare) -> None:
    """Compare as the command line says, where `compare` returns the name of the outcome."""
    directory, first, end = sys.argv[1:]
    outcomes: Counter[str] = Counter()
    for number in range(int(first), int(end)):
        faulthandler.dump_traceback_later(HANG_S, exit=True)
        try:
            outcomes[compare(Path(directory), number)] += 1
        except BaseException as error:
            outcomes["wrong"] += 1
            print(f"input {number}: {type(error).__name__}: {error}", file=sys.__stderr__)
        faulthandler.cancel_dump_traceback_later()
    print(json.dumps(outcomes), file=sys.__stderr__)
    sys.exit(1 if outcomes["wrong"] else 0)


def compared(kind: str, directory: Path, numbers: range) -> dict[str, int]:
    """Run a comparison of these inputs; return how often each outcome occurred."""
    words = [sys.executable, "-m", f"{__package__}.{kind}", directory]
    words += [str(numbers.start), str(numbers.stop)]
    done = subprocess.run(
        words, cwd=TESTS, capture_output=True, text=True, errors="replace", check=False
    )
    assert done.returncode == 0, done.stderr[-10_000:]
    counted: dict[str, int] = json.loads(done.stderr.splitlines()[-1])
    return counted
