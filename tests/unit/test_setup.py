# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The set-up reports missing requirements before it changes anything."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

SETUP = Path(__file__).parents[2] / "scripts/setup.sh"
OLD_PYTHON = """\
#!/bin/sh
[ "$1" = --version ] && echo "Python 3.9.2" && exit
exit 1
"""


def setup_with(python: Path, *words: str, script: Path = SETUP) -> subprocess.CompletedProcess[str]:
    env = {**os.environ, "PYTHON": str(python)}
    return subprocess.run([script, *words], env=env, capture_output=True, text=True, timeout=60)


@pytest.fixture
def old(tmp_path: Path) -> Path:
    python = tmp_path / "python3"
    python.write_text(OLD_PYTHON)
    python.chmod(0o755)
    return python


def test_an_old_python_is_refused(old: Path) -> None:
    result = setup_with(old)
    assert result.returncode == 1
    assert f"Python 3.10 or newer is needed. {old}: Python 3.9.2." in result.stderr


def test_a_python_that_is_not_there_is_refused(tmp_path: Path) -> None:
    result = setup_with(tmp_path / "python3")
    assert result.returncode == 1
    assert "no such program" in result.stderr


@pytest.mark.parametrize("words", [("tests",), ("extra", "view")])
def test_without_a_venv_each_extra_begins_with_the_whole_set_up(
    old: Path, tmp_path: Path, words: tuple[str, ...]
) -> None:
    """The old Python stops it there, before anything is created or installed."""
    script = tmp_path / "tree/scripts/setup.sh"
    script.parent.mkdir(parents=True)
    shutil.copy(SETUP, script)
    result = setup_with(old, *words, script=script)
    assert result.returncode == 1
    assert "Python 3.10 or newer is needed" in result.stderr
