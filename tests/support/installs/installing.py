# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wheels of this checkout, and virtual environments with nothing else installed."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from support import REPOSITORY
from support.processes.own_shm import can_mount

INSTALL_TIMEOUT_S = 1800
BUILD = REPOSITORY / "build/install"  # build directory of this checkout's set-up
READ_ONLY = "mount --bind {0} {0} && mount -o remount,bind,ro {0} && "
COPY = "mount --bind {copy} {build} && "


def run(*command: str | Path, **more: object) -> str:
    """Return the standard output of a command; its standard error is shown if it fails."""
    done = subprocess.run(
        [str(word) for word in command],
        capture_output=True,
        text=True,
        timeout=INSTALL_TIMEOUT_S,
        **more,  # type: ignore[call-overload]
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return str(done.stdout)


def build_wheel(python: Path, directory: Path) -> Path:
    """Return the wheel that `pip install .` would install, built from read-only sources.

    All temporary files are below `directory`: its name in a wheel would show a leaked path.
    """
    script = READ_ONLY.format(shlex.quote(str(REPOSITORY))) if can_mount() else ""
    return _wheel(python, directory, script)


def pack_wheel(directory: Path) -> Path:
    """Return the wheel of the running Python, without compiling again what the set-up compiled.

    Uses a copy of the build directory, mounted over the original for this build alone: object
    files contain the path that they were compiled in.
    """
    python = Path(sys.executable)
    if not BUILD.is_dir() or not can_mount():
        return build_wheel(python, directory)
    copy = directory / "build"
    shutil.copytree(BUILD, copy, symlinks=True)
    script = READ_ONLY.format(shlex.quote(str(REPOSITORY)))
    script += COPY.format(copy=shlex.quote(str(copy)), build=shlex.quote(str(BUILD)))
    return _wheel(
        python, directory, script, "--no-build-isolation", f"--config-settings=build-dir={BUILD}"
    )


def _wheel(python: Path, directory: Path, mounts: str, *options: str) -> Path:
    temporary = directory / "temporary"
    temporary.mkdir()
    command = [python, "-m", "pip", "wheel", "--no-deps", *options, "-w", directory, REPOSITORY]
    isolated = ["unshare", "--mount"] if mounts else []
    words = shlex.join(map(str, command))
    run(*isolated, "sh", "-c", mounts + words, env={**os.environ, "TMPDIR": str(temporary)})
    return next(directory.glob("*.whl"))


class Installation:
    """A virtual environment with the wheel and its dependencies."""

    def __init__(self, python: Path, wheel: Path, directory: Path) -> None:
        run(python, "-m", "venv", "--without-pip", directory)
        self.directory = directory
        self.python = directory / "bin/python"
        self.manycore = directory / "bin/manycore"
        self.install(wheel)

    def install(self, *words: str | Path) -> None:
        """Install with the running Python's pip, and byte-compile what is imported."""
        pip = (sys.executable, "-m", "pip", "--python", self.python)
        run(*pip, "install", "--no-compile", *words)
