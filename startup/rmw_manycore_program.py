# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Import rules of the programs of rmw_manycore, and how other programs start them.

A file in the working directory must not shadow a module: `manycore run` is started next to the
user's files. So these programs never import from the working directory or their script's directory,
and PYTHONPATH comes after the standard library and installed packages. While they load, SIGINT ends
them without a traceback. Nodes keep the rules of Python. See docs/design/substitution.md.

Imports only the start-up hook, os and sys until sys.path is set.
"""

import os
import sys

from rmw_manycore_hook import end_on_interrupt, raise_on_interrupt

COMMAND = "manycore"


def own_program(module: str, *arguments: str) -> tuple[str, ...]:
    """Return the command line that runs a module of ours, instead of `python -m MODULE`."""
    return (sys.executable, os.path.abspath(__file__), module, *arguments)


def manycore() -> None:
    """Run `manycore`; code that handles KeyboardInterrupt calls `raise_on_interrupt()` first."""
    isolate_imports()
    import importlib

    importlib.import_module("rmw_manycore_py.cli").main()


def isolate_imports() -> None:
    """Set sys.path; called in the first lines of a script.

    The script calls `raise_on_interrupt()` after its imports.
    """
    end_on_interrupt()
    script = sys.argv[0]
    directories = [os.path.dirname(path(script)) for path in (os.path.abspath, os.path.realpath)]
    if sys.path[0] in directories:
        del sys.path[0]
    _put_pythonpath_last()


def isolate_own_program() -> None:
    """Set sys.path before other start-up hooks import anything; no-op for nodes."""
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
    """Move the entries of PYTHONPATH to the end; drop an empty one (the working directory)."""
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
