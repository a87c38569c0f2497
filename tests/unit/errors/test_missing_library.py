# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A missing library is one line that names the extra to install."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.metadata import packages_distributions, requires
from pathlib import Path

import pytest

from rmw_manycore_py.errors import ManycoreError, missing_library
from rmw_manycore_py.errors.missing_library import Library, missing, require, require_installed

pytestmark = pytest.mark.unit

LIBRARIES = [one for one in vars(missing_library).values() if isinstance(one, Library)]
ABSENT = Library(("no_such.part",), "dreams need no_such", "sleep", "or stay awake")
TEXT = (
    "dreams need no_such (No module named 'no_such'): pip install 'rmw-manycore[sleep]'; "
    "or stay awake"
)

WITHOUT = """
import sys
sys.modules[sys.argv.pop(1)] = None
from rmw_manycore_py.cli import main
main()
"""


def requirements(extra: str) -> set[str]:
    """Return the names of what an extra installs."""
    lines = [line for line in requires("rmw-manycore") or () if f'extra == "{extra}"' in line]
    return {re.split(r"[^\w-]", line)[0].lower() for line in lines}


def test_a_missing_library() -> None:
    assert missing(ABSENT) == TEXT
    for refuse in (require, require_installed):
        with pytest.raises(ManycoreError, match=re.escape(TEXT)):
            refuse(ABSENT)


@pytest.mark.parametrize("library", LIBRARIES, ids=lambda one: one.modules[0])
def test_its_extra_installs_it(library: Library) -> None:
    installed_by = packages_distributions()
    for module in library.modules:
        top = module.partition(".")[0]
        owners = {name.lower() for name in installed_by.get(top, [top])}
        assert owners & requirements(library.extra)


def test_an_installed_one_is_returned() -> None:
    assert require(missing_library.SIMPY).__name__ == "simpy"
    assert missing(missing_library.SIMPY) == ""


@pytest.mark.parametrize(
    ("library", "command"),
    [
        ("matplotlib", ("bench", "ndt", "--plot", "-o", "results")),
        ("matplotlib", ("ndt", "replay", "drive.npz", "--plot", "replay.png")),
        ("perfetto", ("run", "no_mapfile.yaml", "--trace", "results.pftrace")),
    ],
)
def test_it_is_reported_before_the_run(
    library: str, command: tuple[str, ...], tmp_path: Path
) -> None:
    for name in ("drive.npz", "no_mapfile.yaml"):
        (tmp_path / name).touch()
    run = subprocess.run(
        [sys.executable, "-c", WITHOUT, library, *command],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert run.returncode != 0
    assert re.search(rf" needs? {library} .*: pip install", run.stderr)
    assert "Traceback" not in run.stderr
    assert list(tmp_path.glob("results*")) == []
