# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What launch and we make of launch files of one node, as rcl reads its command line.

FILE has what launch 3.4.3 and launch_ros 0.26.6 make of the first files of generated/launch_files;
null where launch refuses one. Where launch is installed, this makes it anew, in tests/:

    python -m support.comparisons.launch_values 500
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import PlacedNode, check
from rmw_manycore_py.mapfile.launch_file import read_launch_file
from rmw_manycore_py.ros.rcl_parser import RclError, overrides
from support import TESTS
from support.generated.launch_files import Made, made

FILE = TESTS / "unit/mapfile/launch_file/values_of_launch.jsonl"
_ORIGINALS = "support.comparisons.launch_originals"

# Rules and values of the node, by name; no node if it is empty, None for a file that is refused.
Outcome = list[list[Any]] | None


def write(directory: Path, number: int, launch: Made) -> Path:
    """Write a launch file."""
    file = directory / f"made{number}{launch.suffix}"
    file.write_text(launch.text)
    return file


def by_us(file: Path) -> Outcome:
    """Read a launch file as `manycore run` does."""
    mapfile = file.with_name(f"{file.name}.map.yaml")
    mapfile.write_text(f"launch_path: {file.name}\nnodes: {{n: {{cluster: 1}}}}\n")
    try:
        return [_of_node(node) for node in check(mapfile).nodes]
    except MapfileError:
        return [] if _is_without_nodes(file) else None


def _of_node(node: PlacedNode) -> list[Any]:
    texts = {one.name: one.text for one in node.generated_files}
    return _as_rcl_reads(node.command(Path()), texts)


def _is_without_nodes(file: Path) -> bool:
    try:
        return not read_launch_file(file).nodes
    except MapfileError:
        return False


def by_launch(file: Path) -> Outcome:
    """Read a launch file with launch itself."""
    process = _launch()
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(f"{file}\n")
    process.stdin.flush()
    result = json.loads(process.stdout.readline())
    if "error" in result:
        return None
    try:
        return [_as_rcl_reads(one["words"], one["files"]) for one in result["processes"]]
    except RclError:
        return None


@cache
def _launch() -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    return subprocess.Popen(
        [sys.executable, "-m", _ORIGINALS],
        cwd=TESTS,
        stdin=pipe,
        stdout=pipe,
        stderr=subprocess.DEVNULL,
        text=True,
    )


def _as_rcl_reads(words: Sequence[str], files: Mapping[str, str]) -> list[Any]:
    """Return the rules of a command line and its parameters, written with their types."""
    rules = [word for option, word in pairwise(words) if option == "-r"]
    with overrides() as read, tempfile.NamedTemporaryFile("w+") as written:
        for option, word in pairwise(words):
            if option == "-p":
                read.add_value("/**", *word.split(":=", 1))
            elif option == "--params-file":
                written.seek(0)
                written.truncate()
                written.write(files.get(word) or Path(word).read_text())
                written.flush()
                read.add_file(written.name)
        found = {name: value for _, values in read.sections() for name, value in values.items()}
    values = {name: repr(value) for name, value in found.items() if value is not None}
    return [sorted(rules), dict(sorted(values.items()))]


def _main() -> None:
    with tempfile.TemporaryDirectory() as directory, FILE.open("w", encoding="utf-8") as kept:
        for number in range(int(sys.argv[1])):
            outcome = by_launch(write(Path(directory), number, made(number)))
            print(json.dumps(outcome, ensure_ascii=False), file=kept)


if __name__ == "__main__":
    _main()
