# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wheels of this checkout, and environments in which nothing else is installed."""

from __future__ import annotations

import os
import shlex
import subprocess
from pathlib import Path

from support import REPOSITORY

INSTALL_TIMEOUT_S = 1800
READ_ONLY = "mount --bind {0} {0} && mount -o remount,bind,ro {0} && "


def run(*command: str | Path, **more: object) -> str:
    """Return what a command prints; its standard error belongs to the message of a failure."""
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
    """Return the wheel that `pip install .` would install, of sources that cannot be written to.

    Everything temporary lies below `directory`: in a wheel its name would tell where it was built.
    """
    temporary = directory / "temporary"
    temporary.mkdir()
    command = [python, "-m", "pip", "wheel", "--no-deps", "-w", directory, REPOSITORY]
    script = READ_ONLY.format(shlex.quote(str(REPOSITORY))) if can_mount() else ""
    isolated = ["unshare", "--mount"] if script else []
    words = shlex.join(map(str, command))
    run(*isolated, "sh", "-c", script + words, env={**os.environ, "TMPDIR": str(temporary)})
    return next(directory.glob("*.whl"))


def can_mount() -> bool:
    """Tell whether this user may have mounts of its own."""
    probe = ["unshare", "--mount", "true"]
    return os.getuid() == 0 and subprocess.run(probe, capture_output=True).returncode == 0


class Installation:
    """A virtual environment with the wheel and what it depends on."""

    def __init__(self, python: Path, wheel: Path, directory: Path) -> None:
        run(python, "-m", "venv", directory)
        self.directory = directory
        self.python = directory / "bin/python"
        self.manycore = directory / "bin/manycore"
        run(self.python, "-m", "pip", "install", wheel)
