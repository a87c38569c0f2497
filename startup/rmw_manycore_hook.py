# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Loads the middleware named by RMW_IMPLEMENTATION when a Python process starts.

In the ROS 2 wheels librcl.so is linked to librmw_fastrtps_cpp.so by name. The dynamic loader reads
its search path once, at program start, so the process has to be started with our stand-ins first in
LD_LIBRARY_PATH. `rmw_manycore.pth` calls `select()` in every Python process with
RMW_IMPLEMENTATION=rmw_manycore or with the stand-ins; launchers call `substituted_environment()`
instead and save the re-execution. A sourced ROS 2 installation loads the middleware by name, and
only has to find it. See docs/design/substitution.md.

Imports only what Python has already imported: this runs before everything else.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # what signal is made of, without enum
import os
import sys

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from collections.abc import Mapping

IMPLEMENTATION = "rmw_manycore"
LIBRARY_PATH = "LD_LIBRARY_PATH"
AMENT_PREFIX_PATH = "AMENT_PREFIX_PATH"
OWN_LIBRARY = "lib/librmw_manycore.so"
STAND_INS = "/lib/rmw_manycore/standin"
REPLACED_LIBRARY = "librmw_fastrtps_cpp.so"
# Disables the wheels' own start-up hook, which re-executes without keeping the search order.
WHEELS_BOOTSTRAPPED = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
# Process id of the process that re-executed itself, to prevent a second time, and the names of the
# variables that only this process may see.
REPLACED = "_RMW_MANYCORE_REPLACED"
# Value of REPLACED for children of such a process, which inherit everything but those variables.
PARENT = "parent"
# By default glibc returns the memory of each large message to the kernel and faults it in again for
# the next; rclpy takes each message into fresh memory.
MALLOC_TUNING = {"MALLOC_TRIM_THRESHOLD_": str(1 << 30), "MALLOC_MMAP_THRESHOLD_": str(1 << 30)}


# site.py processes each .pth file twice in a virtual environment.
_ran = False


def select() -> None:
    """Re-execute this process if its libraries do not match RMW_IMPLEMENTATION."""
    global _ran
    if _ran:
        return
    _ran = True
    replacer, *own_variables = os.environ.pop(REPLACED, "none").split()
    replaced = replacer == str(os.getpid())
    for name in own_variables if replaced else ():
        os.environ.pop(name, None)  # already read by the loader and by glibc
    if os.environ.get("RMW_IMPLEMENTATION") == IMPLEMENTATION:
        _substitute(replaced, is_child=replacer == PARENT)
    elif needs_stand_ins(sys.prefix) and _finds_stand_in() and _is_python_program():
        restart(plain_environment(os.environ, sys.prefix))


def _substitute(replaced: bool, is_child: bool) -> None:
    extends = extends_ros(os.environ, sys.prefix)
    needed = f"{sys.prefix}/lib" if extends else stand_in_directory(sys.prefix)
    path = library_path(os.environ)
    if needed in (path if extends else path[:1]) and not is_child:
        if replaced:
            os.environ[REPLACED] = PARENT
    elif not ((extends or needs_stand_ins(sys.prefix)) and _is_python_program()):
        return
    elif replaced:
        sys.stderr.write(
            f"rmw_manycore: {LIBRARY_PATH} was lost when {sys.executable} restarted itself, so "
            f"rmw_manycore cannot be used; start it with {LIBRARY_PATH}={needed}\n"
        )
    else:
        environment = substituted_environment(os.environ, sys.prefix)
        tuning = {k: v for k, v in MALLOC_TUNING.items() if k not in environment}
        environment[REPLACED] = " ".join([str(os.getpid()), *tuning])
        restart({**environment, **tuning})


def restart(environment: Mapping[str, str]) -> None:
    """Re-execute this interpreter with the same arguments."""
    end_on_interrupt()
    os.execve(sys.executable, [sys.executable, *sys.orig_argv[1:]], environment)


def end_on_interrupt() -> None:
    """Make SIGINT terminate this process instead of raising KeyboardInterrupt.

    Python handles signals with a delay: never, if `os.execve()` comes first or if an import
    mistakes the exception for its own failure.
    """
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)


def raise_on_interrupt() -> None:
    """Undo `end_on_interrupt()`."""
    if _signal.getsignal(_signal.SIGINT) == _signal.SIG_DFL:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)


def substituted_environment(environment: Mapping[str, str], prefix: str) -> dict[str, str]:
    """Return `environment` for programs of the Python `prefix` to load rmw_manycore."""
    if extends_ros(environment, prefix):
        return _with_own_prefix(environment, prefix)
    return _with_libraries(environment, prefix, stand_in_directory(prefix))


def plain_environment(environment: Mapping[str, str], prefix: str) -> dict[str, str]:
    """Return `environment` for programs of the Python `prefix` to load Fast DDS.

    `environment` may contain the stand-ins, or belong to another prefix.
    """
    return _with_libraries(environment, prefix)


def extends_ros(environment: Mapping[str, str], prefix: str) -> bool:
    """Return whether `prefix` adds rmw_manycore, without the ROS 2 wheels, to a sourced ROS 2."""
    is_sourced = bool(environment.get(AMENT_PREFIX_PATH)) and not needs_stand_ins(prefix)
    return is_sourced and os.path.exists(f"{prefix}/{OWN_LIBRARY}")


def _with_own_prefix(environment: Mapping[str, str], prefix: str) -> dict[str, str]:
    """Return `environment` with `prefix` last: messages of both are those of the sourced ROS 2."""
    result = {name: value for name, value in environment.items() if name != REPLACED}
    for name, own in ((LIBRARY_PATH, f"{prefix}/lib"), (AMENT_PREFIX_PATH, prefix)):
        others = [path for path in environment.get(name, "").split(os.pathsep) if path]
        result[name] = os.pathsep.join(others if own in others else [*others, own])
    return result


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
    """Return whether `prefix` holds the ROS 2 wheels, with the middleware fixed at link time."""
    return os.path.exists(f"{prefix}/lib/{REPLACED_LIBRARY}") and os.path.isdir(
        stand_in_directory(prefix)
    )


def stand_in_directory(prefix: str) -> str:
    """Return the directory of the stand-ins, libraries with the names of Fast DDS's."""
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
    """Return whether the loader finds a stand-in, of any prefix, before the real library."""
    path = library_path(os.environ)
    found = (entry for entry in path if os.path.exists(f"{entry}/{REPLACED_LIBRARY}"))
    return next(found, "").rstrip("/").endswith(STAND_INS)


def _is_python_program() -> bool:
    """Return whether this is the Python program, not one that embeds Python."""
    return bool(sys.executable) and os.path.samefile("/proc/self/exe", sys.executable)
