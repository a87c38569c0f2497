# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The programs of rmw_manycore itself: where they import from, and how others start them.

A file in the working directory that is named like a module must not take the module's place:
`manycore run` is started wherever the user's files are. So none of our own programs imports from
the working directory or from the directory of its script, and for all of them PYTHONPATH comes
after the standard library and the installed packages. While they load, SIGINT ends them without
a traceback. Nodes keep the rules of Python. See docs/design/substitution.md.

Imports nothing but the start-up hook, os and sys until the path of imports is in order.
"""

import os
import sys

from rmw_manycore_hook import end_on_interrupt, raise_on_interrupt

COMMAND = "manycore"


def own_program(module: str, *arguments: str) -> tuple[str, ...]:
    """Return the command line that runs a module of ours, in place of `python -m MODULE`."""
    return (sys.executable, os.path.abspath(__file__), module, *arguments)


def manycore() -> None:
    """Be the command `manycore`; what catches KeyboardInterrupt calls `raise_on_interrupt()`."""
    isolate_imports()
    import importlib

    importlib.import_module("rmw_manycore_py.cli").main()


def isolate_imports() -> None:
    """Put the path of imports in order; for the first lines of a script.

    The script calls `raise_on_interrupt()` when it has imported what it needs.
    """
    end_on_interrupt()
    script = sys.argv[0]
    directories = [os.path.dirname(path(script)) for path in (os.path.abspath, os.path.realpath)]
    if sys.path[0] in directories:
        del sys.path[0]
    _put_pythonpath_last()


def isolate_own_program() -> None:
    """Put the path in order before other start-up hooks import anything; no-op for nodes."""
    if _is_own(os.path.realpath(sys.argv[0])):
        end_on_interrupt()
        _put_pythonpath_last()


def _is_own(script: str) -> bool:
    directory, name = os.path.split(script)
    prefix = os.path.realpath(sys.prefix)
    return (
        (directory == f"{prefix}/bin" and name == COMMAND)
        or directory == f"{prefix}/lib/rmw_manycore"
        or script == os.path.realpath(__file__)
    )


def _put_pythonpath_last() -> None:
    """Move the entries of PYTHONPATH to the end; drop an empty one, the working directory."""
    entries = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    if entries == [""]:
        return
    standard, own = (
        os.path.dirname(os.path.abspath(str(file))) for file in (os.__file__, __file__)
    )
    named = {os.path.abspath(entry) for entry in entries if entry} - {standard}
    unwanted = {"", os.path.abspath("")} - {standard, own} - named if "" in entries else set()
    last = [path for path in sys.path if path in named]
    sys.path[:] = [path for path in sys.path if path not in named | unwanted] + last


def _run_module() -> None:
    isolate_imports()
    import runpy

    del sys.argv[0]
    raise_on_interrupt()
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    _run_module()
