# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A virtual environment with our start-up files, and real Python processes that use it."""

from __future__ import annotations

import json
import shutil
import subprocess
import venv
from pathlib import Path

import rmw_manycore_hook as hook
from support import TIMEOUT_S

STARTUP = (
    *("arrays", "distribution", "executor", "fields", "hook", "interfaces", "loading"),
    "program",
)
SHOW = (
    "import json, os, sys; print(json.dumps({'environ': dict(os.environ), 'argv': sys.argv,"
    "'orig_argv': sys.orig_argv[1:], 'flags': sys.flags.utf8_mode, 'path': sys.path,"
    "'pid': os.getpid(),"
    "'loader': open('/proc/self/environ').read().split(chr(0))}))"
)


class Prefix:
    """A virtual environment with our hook and files named like those of the ROS 2 wheels."""

    def __init__(self, path: Path) -> None:
        venv.create(path, symlinks=True)
        self.path = path
        self.python = path / "bin/python"
        self.site_packages = next(path.glob("lib/python*/site-packages"))
        self.stand_ins = path / "lib/rmw_manycore/standin"
        for name in STARTUP:
            shutil.copy(Path(hook.__file__).parent / f"rmw_manycore_{name}.py", self.site_packages)
        shutil.copy(Path(hook.__file__).parent / "rmw_manycore.pth", self.site_packages)
        self.stand_ins.mkdir(parents=True)
        (self.site_packages / "ros_rcl.libs").mkdir()
        for directory in (path / "lib", self.stand_ins):
            (directory / "librmw_fastrtps_cpp.so").touch()

    def run(
        self, *arguments: str | Path, directory: Path | None = None, **variables: str
    ) -> subprocess.CompletedProcess[str]:
        environment = {"PATH": "/usr/bin:/bin", "RMW_IMPLEMENTATION": "rmw_manycore", **variables}
        return subprocess.run(
            [self.python, *arguments],
            env=environment,
            cwd=directory,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
        )

    def show(self, *arguments: str | Path, directory: Path | None = None, **variables: str) -> dict:
        done = self.run(*(arguments or ("-c", SHOW)), directory=directory, **variables)
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""
        return json.loads(done.stdout)

    @property
    def wheel_libraries(self) -> list[str]:
        return [f"{self.path}/lib", f"{self.site_packages}/ros_rcl.libs"]
