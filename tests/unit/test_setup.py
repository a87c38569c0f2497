# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The set-up reports missing requirements before it changes anything."""

from __future__ import annotations

import os
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


def setup_with(python: Path) -> subprocess.CompletedProcess[str]:
    env = {**os.environ, "PYTHON": str(python)}
    return subprocess.run([SETUP], env=env, capture_output=True, text=True, timeout=60)


def test_an_old_python_is_refused(tmp_path: Path) -> None:
    old = tmp_path / "python3"
    old.write_text(OLD_PYTHON)
    old.chmod(0o755)
    result = setup_with(old)
    assert result.returncode == 1
    assert f"Python 3.10 or newer is needed. {old}: Python 3.9.2." in result.stderr


def test_a_python_that_is_not_there_is_refused(tmp_path: Path) -> None:
    result = setup_with(tmp_path / "python3")
    assert result.returncode == 1
    assert "no such program" in result.stderr
