# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Command lines that launch and we make from launch files of one node, as rcl reads them.

python launch_values.py FIRST LAST: prints launch's outcome for `made_launch_values.made` of each
number, one line of JSON each; null if launch refuses the file.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import ros2_packages
from made_launch_values import Made, made

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import PlacedNode, check
from rmw_manycore_py.mapfile.launch_file import read_launch_file
from rmw_manycore_py.ros.rcl_parser import RclError, overrides

# Rules and values of the node, by name; no node if it is empty, None for a file that is refused.
Outcome = list[list[Any]] | None
_SCRIPT = Path(__file__).with_name("launch_originals.py")


def by_launch(files: Sequence[Path], environment: Mapping[str, str]) -> list[Outcome]:
    """Read launch files with launch itself."""
    listed = files[0].with_name("list")
    listed.write_text("".join(f"{file}\n" for file in files))
    words = [sys.executable, str(_SCRIPT), str(listed)]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    results = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(results) == len(files), done.stderr
    return [_of_launch(result) for result in results]


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


def write(directory: Path, number: int, launch: Made) -> Path:
    """Write a launch file."""
    file = directory / f"made{number}{launch.suffix}"
    file.write_text(launch.text)
    return file


def _of_launch(result: Mapping[str, Any]) -> Outcome:
    if "error" in result:
        return None
    try:
        return [_as_rcl_reads(one["words"], one["files"]) for one in result["processes"]]
    except RclError:
        return None


def _as_rcl_reads(words: Sequence[str], files: Mapping[str, str] | None = None) -> list[Any]:
    """Return the rules of a command line and its parameters, written with their types."""
    rules = [word for option, word in pairwise(words) if option == "-r"]
    with overrides() as read, tempfile.NamedTemporaryFile("w+") as written:
        for option, word in pairwise(words):
            if option == "-p":
                read.add_value("/**", *word.split(":=", 1))
            elif option == "--params-file":
                written.seek(0)
                written.truncate()
                written.write((files or {}).get(word) or Path(word).read_text())
                written.flush()
                read.add_file(written.name)
        found = {name: value for _, values in read.sections() for name, value in values.items()}
    values = {name: repr(value) for name, value in found.items() if value is not None}
    return [sorted(rules), dict(sorted(values.items()))]


def _main() -> None:
    first, last = map(int, sys.argv[1:])
    with tempfile.TemporaryDirectory() as directory:
        environment = {**os.environ, **ros2_packages.environment(Path(directory, "packages"))}
        files = [write(Path(directory), number, made(number)) for number in range(first, last)]
        for outcome in by_launch(files, environment):
            print(json.dumps(outcome, ensure_ascii=False))


if __name__ == "__main__":
    _main()
