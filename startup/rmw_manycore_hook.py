# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Gives python processes the middleware that RMW_IMPLEMENTATION names, when they start.

In the ROS 2 wheels librcl.so is linked to librmw_fastrtps_cpp.so by name. The dynamic loader reads
its search path once, at program start, so the only way in is a process whose LD_LIBRARY_PATH names
our stand-ins first. `rmw_manycore.pth` calls `select()` in every python process that has
RMW_IMPLEMENTATION=rmw_manycore or the stand-ins; a launcher calls `substituted_environment()`
instead and saves the second start. See docs/design/substitution.md.

Imports nothing that python has not imported by then: this runs before everything else.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # what signal is made of, without enum
import os
import sys

TYPE_CHECKING = False  # as typing has it, without importing typing
if TYPE_CHECKING:
    from collections.abc import Mapping

IMPLEMENTATION = "rmw_manycore"
LIBRARY_PATH = "LD_LIBRARY_PATH"
STAND_INS = "/lib/rmw_manycore/standin"
REPLACED_LIBRARY = "librmw_fastrtps_cpp.so"
# The wheels' own start-up hook does the same trick without keeping an order; this tells it not to.
WHEELS_BOOTSTRAPPED = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
# Holds the id of the process that replaced itself, so that it cannot do so a second time, and the
# names of the variables that are for this process only.
REPLACED = "_RMW_MANYCORE_REPLACED"
# What REPLACED says to the children of such a process: they inherit all but those variables.
PARENT = "parent"
# By default glibc gives the memory of each large message back and gets it again, page by page, for
# the next; rclpy takes each message into fresh memory.
MALLOC_TUNING = {"MALLOC_TRIM_THRESHOLD_": str(1 << 30), "MALLOC_MMAP_THRESHOLD_": str(1 << 30)}


# In a virtual environment site.py processes each .pth file twice.
_ran = False


def select() -> None:
    """Restart this process if its libraries are not those of RMW_IMPLEMENTATION."""
    global _ran
    if _ran:
        return
    _ran = True
    replacer, *own_variables = os.environ.pop(REPLACED, "none").split()
    replaced = replacer == str(os.getpid())
    for name in own_variables if replaced else ():
        os.environ.pop(name, None)  # read by the loader and by glibc before python started
    if os.environ.get("RMW_IMPLEMENTATION") == IMPLEMENTATION:
        _substitute(replaced, is_child=replacer == PARENT)
    elif needs_stand_ins(sys.prefix) and _finds_stand_in() and _is_python_program():
        restart(plain_environment(os.environ, sys.prefix))


def _substitute(replaced: bool, is_child: bool) -> None:
    stand_ins = stand_in_directory(sys.prefix)
    if library_path(os.environ)[:1] == [stand_ins] and not is_child:
        if replaced:
            os.environ[REPLACED] = PARENT
    elif not (needs_stand_ins(sys.prefix) and _is_python_program()):
        return
    elif replaced:
        sys.stderr.write(
            f"rmw_manycore: {LIBRARY_PATH} was lost when {sys.executable} restarted itself, so "
            f"rmw_manycore cannot be used; start it with {LIBRARY_PATH}={stand_ins}\n"
        )
    else:
        environment = substituted_environment(os.environ, sys.prefix)
        tuning = {k: v for k, v in MALLOC_TUNING.items() if k not in environment}
        environment[REPLACED] = " ".join([str(os.getpid()), *tuning])
        restart({**environment, **tuning})


def restart(environment: Mapping[str, str]) -> None:
    """Start this python anew, with the same arguments."""
    end_on_interrupt()
    os.execve(sys.executable, [sys.executable, *sys.orig_argv[1:]], environment)


def end_on_interrupt() -> None:
    """Let SIGINT end this process, where it would raise KeyboardInterrupt.

    Python notes a signal and acts on it later: never, if `os.execve()` comes first or if some
    import takes the exception for a failure of its own.
    """
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)


def raise_on_interrupt() -> None:
    """Undo `end_on_interrupt()`."""
    if _signal.getsignal(_signal.SIGINT) == _signal.SIG_DFL:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)


def substituted_environment(environment: Mapping[str, str], prefix: str) -> dict[str, str]:
    """Return `environment` as a program of the python `prefix` needs it to get rmw_manycore.

    An ordinary ROS 2 install selects the middleware by itself: there nothing changes.
    """
    return _with_libraries(environment, prefix, stand_in_directory(prefix))


def plain_environment(environment: Mapping[str, str], prefix: str) -> dict[str, str]:
    """Return `environment` as a program of the python `prefix` needs it to get Fast DDS.

    It may come from a shell that has the stand-ins, or from a python of another prefix.
    """
    return _with_libraries(environment, prefix)


def _with_libraries(
    environment: Mapping[str, str], prefix: str, *before_wheels: str
) -> dict[str, str]:
    result = {name: value for name, value in environment.items() if name != REPLACED}
    if needs_stand_ins(prefix):
        first = [*before_wheels, *_wheel_library_directories(prefix)]
        known = {stand_in_directory(prefix), *first}
        rest = [path for path in library_path(environment) if path not in known]
        result[LIBRARY_PATH] = os.pathsep.join(first + rest)
        result[WHEELS_BOOTSTRAPPED] = "1"
    return result


def needs_stand_ins(prefix: str) -> bool:
    """Tell whether `prefix` holds the ROS 2 wheels, with the middleware fixed at link time."""
    return os.path.exists(f"{prefix}/lib/{REPLACED_LIBRARY}") and os.path.isdir(
        stand_in_directory(prefix)
    )


def stand_in_directory(prefix: str) -> str:
    """Return where the libraries lie that bear the names of Fast DDS's."""
    return prefix + STAND_INS


def library_path(environment: Mapping[str, str]) -> list[str]:
    """Return the directories of the loader's search path."""
    return [path for path in environment.get(LIBRARY_PATH, "").split(os.pathsep) if path]


def _wheel_library_directories(prefix: str) -> list[str]:
    site_packages = f"{prefix}/lib/python{sys.version_info[0]}.{sys.version_info[1]}/site-packages"
    bundled = sorted(
        name
        for name in os.listdir(site_packages)
        if name.startswith("ros_") and name.endswith(".libs")
    )
    return [f"{prefix}/lib", *(f"{site_packages}/{name}" for name in bundled)]


def _finds_stand_in() -> bool:
    """Tell whether the loader finds a stand-in, of whatever prefix, before the library itself."""
    path = library_path(os.environ)
    found = (entry for entry in path if os.path.exists(f"{entry}/{REPLACED_LIBRARY}"))
    return next(found, "").rstrip("/").endswith(STAND_INS)


def _is_python_program() -> bool:
    """Tell python from a program that embeds it and cannot be restarted as python."""
    return bool(sys.executable) and os.path.samefile("/proc/self/exe", sys.executable)
