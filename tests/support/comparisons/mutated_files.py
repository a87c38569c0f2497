# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads mutated files in a process: python -m MODULE DIRECTORY FIRST LAST.

Each input is derived from its number alone. Prints a line for each input whose reading ends neither
well nor in a MapfileError with one line per problem. An input that hangs ends the process with a
traceback of the place; that input stays in the directory.
"""

from __future__ import annotations

import faulthandler
import random
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from rmw_manycore_bridge.config import load_bridge_file
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.launch_file import read_launch_file
from support import REPOSITORY, TESTS
from support.generated.mutation import mutated, mutated_data, mutated_lines, mutated_words

FOLDERS = (
    *("mapfiles", "launch_scripts", "tests/unit/mapfile/invalid"),
    *("tests/unit/mapfile/invalid_launch", "tests/unit/bridge/files"),
)
# Far above what any input takes on a busy machine: only an endless loop takes longer.
HANG_S = 120

_YAML = (mutated_data, mutated_data, mutated_lines, mutated_words)
_OTHER = (mutated_lines, mutated_words)


def reader_of(file: Path) -> Callable[[Path], object] | None:
    """Return the function that reads such a file."""
    if file.parent.name == "files":
        return lambda path: load_bridge_file(path, inside=2)
    if file.name.endswith(".params.yaml"):
        return check_parameters
    if file.parent.name in ("launch_scripts", "invalid_launch"):
        return read_launch_file
    return check if file.suffix in (".yaml", ".map") else None


def check_parameters(file: Path) -> object:
    """Check a mapfile whose node has this parameter file."""
    mapfile = file.with_name("with_parameters.yaml")
    mapfile.write_text(
        f"nodes: {{talker: {{cluster: 1, command: [sh], param_file: {file.name}}}}}\n"
    )
    return check(mapfile)


def corpus(directory: Path) -> list[list[Path]]:
    """Copy the files to mutate and what they refer to; return those of each directory, sorted."""
    for folder in FOLDERS:
        shutil.copytree(REPOSITORY / folder, directory / folder, dirs_exist_ok=True)
    files = [
        [directory / folder / f.name for f in (REPOSITORY / folder).iterdir()] for folder in FOLDERS
    ]
    return [sorted(f for f in folder if f.is_file() and reader_of(f)) for folder in files]


def complaint(error: BaseException) -> str | None:
    """Return what is wrong with the error of a refused input."""
    if not isinstance(error, MapfileError):
        return f"{type(error).__name__}: {error}"
    lines = str(error).split("\n")
    expected = len(error.problems) + len(error.hints)
    if len(lines) != expected or not all(line.isprintable() for line in lines):
        return f"not one line per problem: {error}"
    return None


def run(directory: Path, numbers: range) -> Counter[str]:
    """Read the inputs; return how often each outcome occurred."""
    folders = corpus(directory)
    ends: Counter[str] = Counter()
    for number in numbers:
        chance = random.Random(number)
        file = chance.choice(chance.choice(folders))  # few inputs are valid, and few are alike
        kinds = _YAML if file.suffix in (".yaml", ".map") else _OTHER
        path = file.with_name(f"input{number}_{file.name}")
        faulthandler.dump_traceback_later(HANG_S, exit=True)
        path.write_bytes(mutated(chance, file.read_bytes(), kinds))
        read = reader_of(file)
        assert read is not None
        found = None
        try:
            read(path)
            ends["read"] += 1
        except BaseException as error:
            found = complaint(error)
            ends["refused" if found is None else "wrong"] += 1
        faulthandler.cancel_dump_traceback_later()
        if found is None:
            path.unlink()
        else:
            print(f"input {number} ({path}): {found}", flush=True)
    return ends


def read_mutated(directory: Path, numbers: range) -> tuple[int, str]:
    """Run this file in a process; return its exit status and its lines about wrong inputs."""
    words = [sys.executable, "-m", __name__, directory, str(numbers.start), str(numbers.stop)]
    done = subprocess.run(
        words, cwd=TESTS, capture_output=True, text=True, errors="replace", check=False
    )
    return done.returncode, done.stdout + done.stderr


if __name__ == "__main__":
    target, first, last = sys.argv[1:]
    counted = run(Path(target), range(int(first), int(last)))
    print(", ".join(f"{number} {end}" for end, number in sorted(counted.items())))
    sys.exit(1 if counted["wrong"] else 0)
