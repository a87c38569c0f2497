# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Our programs as peers: forks of a process that has imported what they import.

For tests that start many programs and check what each does, not how it starts:
tests/integration/test_installed.py and most others start an interpreter for each.
"""

from __future__ import annotations

import runpy
import sys

from support.processes.commands import manycore_command, peer_command


def forked_manycore(*arguments: object) -> list[str]:
    """Return the command of a peer that is the command line tool."""
    return peer_command(run_manycore, *map(str, arguments))


def forked_node(module: str, *arguments: str) -> list[str]:
    """Return the command of a peer that is `python -m MODULE`."""
    return peer_command(run_module, module, *arguments)


def forked_example(name: str, *arguments: str) -> list[str]:
    """Return the command of a peer that is one of the example nodes."""
    return forked_node(f"rmw_manycore_py.examples.{name}", *arguments)


def run_manycore(*arguments: str) -> None:
    from rmw_manycore_program import manycore

    _become([str(word) for word in manycore_command(*arguments)])
    manycore()


def run_module(module: str, *arguments: str) -> None:
    _become([module, *arguments], "-m")
    runpy.run_module(module, run_name="__main__", alter_sys=True)


def _become(argv: list[str], *options: str) -> None:
    """Let the program see its own command line, also after it restarts itself."""
    sys.argv[:] = argv
    sys.orig_argv[:] = [sys.executable, *options, *argv]
